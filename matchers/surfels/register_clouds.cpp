#include "glocal/register_clouds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "glocal/cloud_resolution.hpp"
#include "matchers/surfels/point_to_plane.hpp"
#include "matchers/surfels/pose_search.hpp"

namespace glocal {
namespace {

/// Pairs of the target that are looked up.
constexpr std::size_t pairs_in_table = 60'000;

/// Names of the random streams of a registration.
enum Stream : std::uint64_t { table, search, last_refinement };

/// Whether points may have been seen from a place. Points behind others speak against it; in any scan there
/// are some, at edges and in trees: up to half of them in scans of streets, two thirds and more in maps.
bool may_be_seen_from(const Points& cloud, const Point& place, float voxel_size) {
  constexpr double most_hidden = 0.58;
  const surfels::RangeView view(cloud, place);
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (length(cloud[i] - place) > 1.1F * view.shortest_range_towards(cloud[i]) + 3.0F * voxel_size) ++hidden;
  }
  return static_cast<double>(hidden) <= most_hidden * static_cast<double>(cloud.size());
}

/// Surfels that lie on surfels of the other cloud.
struct Inliers {
  double share = 0.0;
  double squared_distances = 0.0;  ///< Mean, m^2
};

Inliers inliers_of(const surfels::Surfels& moved, const RigidMotion& motion,
                   const surfels::SurfelContact& other) {
  std::size_t n = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Point p = motion(moved.points[i]);
    const std::uint32_t k = other.nearest(p);
    if (k == surfels::VoxelTable::none || !other.lies_on(k, p, motion.turned(moved.normals[i]))) continue;
    const double distance = static_cast<double>(dot(other.plane(k).normal, p) - other.plane(k).distance);
    sum += distance * distance;
    ++n;
  }
  if (n == 0) return {};
  return {static_cast<double>(n) / static_cast<double>(moved.size()), sum / static_cast<double>(n)};
}

/// By the score and the lead of the best pose. Of the pairs that this was set by, 13 of 14 wrong answers were
/// below, and 2 of 106 right ones. Contact alone, where nothing tells what was seen through, must be much
/// more.
void judge(Registration& result) {
  const double least = result.sensors_known ? 0.2 : 0.6;
  result.is_match = result.score + result.lead >= least;
  result.why = fmt::format("score {:.2f}, {:.2f} above any other pose: their sum is {} {}", result.score,
                           result.lead, result.is_match ? "at least" : "below", least);
}

}  // namespace

Registration register_clouds(const Points& source, const Points& target, const RegistrationOptions& options) {
  Registration result;
  const float voxel_size =
      options.voxel_size ? static_cast<float>(*options.voxel_size) : cloud_resolution(source, target);
  result.voxel_size = static_cast<double>(voxel_size);
  result.sensors_known = may_be_seen_from(source, options.source_seen_from, voxel_size) &&
                         may_be_seen_from(target, options.target_seen_from, voxel_size);
  const auto prepared = [&](const Points& cloud, const Point& seen_from) {
    return surfels::PreparedCloud(cloud, voxel_size,
                                  result.sensors_known ? std::optional(seen_from) : std::nullopt);
  };
  const surfels::PreparedCloud from = prepared(source, options.source_seen_from);
  const surfels::PreparedCloud to = prepared(target, options.target_seen_from);

  const Rng rng(options.seed);
  const surfels::PairRule rule = surfels::pair_rule(voxel_size, !result.sensors_known);
  const surfels::PairTable pairs(to.surfels, rule, pairs_in_table, rng.stream({table}));
  surfels::PoseSearch search_of_poses(to, pairs, rule, from, {.rounds = 40}, rng.stream({search}));
  search_of_poses.advance(surfels::PoseSearch::to_the_end);
  const std::vector<surfels::FoundPose> found = search_of_poses.result().poses;
  if (found.empty()) {
    result.why = "no two pieces of surface fix a pose: are the clouds flat, or too sparse for their voxels?";
    return result;
  }
  result.score = found[0].score;
  result.lead = found[0].score - (found.size() > 1 ? std::max(found[1].score, 0.0) : 0.0);
  judge(result);

  constexpr int steps = 15;
  Rng last = rng.stream({last_refinement});
  const RigidMotion motion =
      refined(found[0].target_from_source, sample_of(from.surfels, from.surfels.size(), last),
              from.surfels.size(), to.contact, steps, false);
  result.target_from_source = motion.pose();
  const Inliers of_source = inliers_of(from.surfels, motion, to.contact);
  const Inliers of_target = inliers_of(to.surfels, inverse(motion), from.contact);
  result.overlap = std::min(of_source.share, of_target.share);
  result.rmse = std::sqrt(of_source.squared_distances);
  return result;
}

}  // namespace glocal
