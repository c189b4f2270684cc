#include "sources/conversion/map_split.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace glocal::conversion {
namespace {

/// Whether a place of the drive, as a share of its path, is in one of the segments.
bool contains(const PathSegments& segments, double share) {
  return std::ranges::any_of(segments, [&](const auto& segment) {
    return share >= segment[0] && (share < segment[1] || segment[1] >= 1.0);
  });
}

/// How far along the path each scan is, as a share of it.
std::vector<double> shares_of_path(const std::vector<TrackedScan>& scans) {
  std::vector<double> lengths(scans.size(), 0.0);
  for (std::size_t i = 1; i < scans.size(); ++i)
    lengths[i] = lengths[i - 1] + distance(scans[i - 1].odom_from_robot, scans[i].odom_from_robot);
  const double total = lengths.empty() ? 0.0 : lengths.back();
  for (double& length : lengths) length = total > 0.0 ? length / total : 0.0;
  return lengths;
}

double share_near_map(const std::vector<TrackedScan>& scans, const MapSplit& split) {
  const std::vector<double> shares = shares_of_path(scans);
  std::vector<Pose3> mapped, driven;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!scans[i].map_from_robot) continue;
    if (contains(split.map, shares[i])) mapped.push_back(*scans[i].map_from_robot);
    if (contains(split.run, shares[i])) driven.push_back(*scans[i].map_from_robot);
  }
  mapped = sparse_path(mapped);
  driven = sparse_path(driven);
  const auto is_near = [&](const Pose3& pose) {
    return std::ranges::any_of(mapped,
                               [&](const Pose3& place) { return distance(place, pose) <= near_map_m; });
  };
  const auto near = std::ranges::count_if(driven, is_near);
  return driven.empty() ? 0.0 : static_cast<double>(near) / static_cast<double>(driven.size());
}

/// Shares as people write them.
double rounded(double share) {
  return std::round(share * 1e4) / 1e4;
}

}  // namespace

MapSplit split_drive(const std::vector<TrackedScan>& scans, int blocks, double map_share) {
  MapSplit split;
  for (int i = 0; i < blocks; ++i) {
    const double begin = rounded(static_cast<double>(i) / blocks);
    const double middle = rounded((i + map_share) / blocks);
    const double end = rounded((i + 1.0) / blocks);
    split.map.push_back({begin, middle});
    split.run.push_back({middle, end});
  }
  split.run_near_map = share_near_map(scans, split);
  return split;
}

MapSplit choose_split(const std::vector<TrackedScan>& scans, std::optional<int> blocks) {
  constexpr double enough = 0.5;
  for (const double share : {0.3, 0.4, 0.5, 0.6, 0.7}) {
    MapSplit split = split_drive(scans, blocks.value_or(1), share);
    if (split.run_near_map >= enough) return split;
  }
  return split_drive(scans, blocks.value_or(5), 0.5);
}

std::string segments_yaml(const PathSegments& segments) {
  std::vector<std::string> texts;
  for (const auto& [from, to] : segments) texts.push_back(fmt::format("[{}, {}]", from, to));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

}  // namespace glocal::conversion
