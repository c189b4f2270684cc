#include "matchers/modes.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace glocal {

std::vector<Mode> distinct_modes(std::vector<Mode> modes, const Pose2& local_from_robot, const ModeRule& rule,
                                 std::size_t most) {
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return a.quality > b.quality; });
  std::vector<Mode> kept;
  std::vector<Pose2> robots;
  for (const Mode& mode : modes) {
    const Pose2 robot = mode.map_from_local * local_from_robot;
    const bool repeats = std::any_of(robots.begin(), robots.end(),
                                     [&](const Pose2& other) { return is_same_mode(robot, other, rule); });
    if (repeats) continue;
    kept.push_back(mode);
    robots.push_back(robot);
    if (kept.size() == most) break;
  }
  return kept;
}

void refine(std::vector<Mode>& modes, const DistanceField& field, const Points& anchors,
            const PoseRefinement& refinement, const ContactIndex& contact, const Points& points) {
  for (Mode& mode : modes) {
    mode.map_from_local = refined_pose(field, anchors, mode.map_from_local, refinement);
    mode.quality = contact.share(points, Transform(mode.map_from_local));
  }
}

Points sample_of(const Points& points, std::size_t n, Rng& rng) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  Points sample;
  for (std::size_t i = 0; i < std::min(n, order.size()); ++i) {
    std::swap(order[i], order[i + rng.below(static_cast<std::uint32_t>(order.size() - i))]);
    sample.push_back(points[order[i]]);
  }
  return sample;
}

Points first_of(const Points& points, std::size_t n) {
  Points first;
  for (std::size_t i = 0; i < std::min(n, points.size()); ++i) first.push_back(points[i]);
  return first;
}

}  // namespace glocal
