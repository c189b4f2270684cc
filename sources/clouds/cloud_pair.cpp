#include "sources/clouds/cloud_pair.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::clouds {
namespace {

CloudPair pair_of(const CloudPairParams& params, const SourceSetup& setup) {
  const std::filesystem::path& file = params.list.resolved;
  setup.note_input(file);
  std::vector<CloudPair> pairs = read_cloud_pairs(file);
  const auto number = static_cast<std::size_t>(params.number);
  if (number > pairs.size())
    throw ConfigError(file, fmt::format("has {} pairs, and no pair {}", pairs.size(), number));
  return std::move(pairs[number - 1]);
}

PointCloudMap::Params target_of(const CloudPair& pair) {
  PointCloudMap::Params params;
  params.path = {pair.target, pair.target_file};
  return params;
}

}  // namespace

void describe(ParamVisitor& v, CloudPairParams& p) {
  v.field("list", p.list,
          {.doc = "CSV file of pairs: source, target, and the pose tx, ty, tz, qx, qy, qz, qw of the source "
                  "in the target.",
           .required = true});
  v.field("number", p.number,
          {.doc = "Which of its pairs, from 1. Map and observations must name the same.", .min = 1.0});
}

CloudPairMap::CloudPairMap(const Params& params, const SourceSetup& setup)
    : target_(target_of(pair_of(params, setup)), setup) {}

CloudPairScan::CloudPairScan(const Params& params, const SourceSetup& setup) : pair_(pair_of(params, setup)) {
  setup.note_input(pair_.source_file);
}

std::optional<Sample> CloudPairScan::next() {
  if (std::exchange(is_read_, true)) return std::nullopt;
  Cloud cloud = read_cloud(pair_.source_file, {});
  Sample sample{.observation = {}, .map_from_robot = pair_.target_from_source};
  sample.observation.scan.hits = std::move(cloud.points);
  sample.observation.scan.origin = as_point(cloud.viewpoint.translation());
  return sample;
}

}  // namespace glocal::clouds
