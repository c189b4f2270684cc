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

std::vector<std::uint32_t> draw_numbers(std::size_t n, std::size_t below, Rng& rng) {
  std::vector<std::uint32_t> numbers(below);
  std::iota(numbers.begin(), numbers.end(), 0U);
  const std::size_t size = std::min(n, below);
  for (std::size_t i = 0; i < size; ++i) {
    std::swap(numbers[i], numbers[i + rng.below(static_cast<std::uint32_t>(below - i))]);
  }
  numbers.resize(size);
  return numbers;
}

Points sample_of(const Points& points, std::size_t n, Rng& rng) {
  Points sample;
  for (const std::uint32_t i : draw_numbers(n, points.size(), rng)) sample.push_back(points[i]);
  return sample;
}

Points first_of(const Points& points, std::size_t n) {
  Points first;
  for (std::size_t i = 0; i < std::min(n, points.size()); ++i) first.push_back(points[i]);
  return first;
}

}  // namespace glocal
