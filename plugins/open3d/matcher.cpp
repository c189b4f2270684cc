#include "matcher.hpp"

#include <fmt/format.h>

namespace glocal {
namespace {

/// The middle of a map: its features need a side for each normal, and where it was seen from is not known.
Vector3 middle_of(const Points& points) {
  const auto mean = [&](const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  return {mean(points.x), mean(points.y), mean(points.z)};
}

}  // namespace

std::shared_ptr<const FeatureMap> feature_map(const GlobalMap& map, double voxel_size) {
  auto result = map.index<FeatureMap>(fmt::format("{}", voxel_size), [&] {
    const auto start = std::chrono::steady_clock::now();
    FeatureMap made{FeatureCloud(map.points(), voxel_size, middle_of(map.points()))};
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    made.build_ms = time.count();
    return made;
  });
  if (result->cloud.size() >= fewest_points) return result;
  throw ConfigError({{"", 0, 0,
                      fmt::format("the map has {} voxels of {:.2f} m with points; features need {} or more: "
                                  "take a smaller voxel_size",
                                  result->cloud.size(), voxel_size, fewest_points)}});
}

}  // namespace glocal
