// Distinct poses among many that mean nearly the same.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"

namespace glocal {

/// A pose of the local map, and how good it looks so far.
struct Candidate {
  Pose2 map_from_local;
  double quality = 0.0;
};

/// Robot poses nearer to each other than this, m, …
inline constexpr double candidate_distance = 0.4;
/// … and turned by less than this are one candidate: refinement leads from one to the other.
inline constexpr double candidate_rotation = radians(11.5);

/// Of robot poses in the plane (Pose2) or in space (Pose3).
template <class Pose>
[[nodiscard]] bool is_same_candidate(const Pose& a, const Pose& b) {
  // Most are far apart, and seen to be so along one axis.
  const auto are_near = [](double u, double v) { return std::abs(u - v) < candidate_distance; };
  return are_near(a.x, b.x) && are_near(a.y, b.y) && distance(a, b) < candidate_distance &&
         rotation_between(a, b) < candidate_rotation;
}

/// The best first, at most `most`, leaving out those that only repeat a better one: the same robot pose.
/// A candidate has a `map_from_local` and a `quality`.
template <class Candidate, class Pose>
[[nodiscard]] std::vector<Candidate> distinct_candidates(std::vector<Candidate> candidates,
                                                         const Pose& local_from_robot, std::size_t most) {
  std::ranges::stable_sort(candidates, std::greater<>(), &Candidate::quality);
  std::vector<Candidate> kept;
  std::vector<Pose> robots;
  for (const Candidate& candidate : candidates) {
    const Pose robot = candidate.map_from_local * local_from_robot;
    const bool repeats = std::any_of(robots.begin(), robots.end(),
                                     [&](const Pose& other) { return is_same_candidate(robot, other); });
    if (repeats) continue;
    kept.push_back(candidate);
    robots.push_back(robot);
    if (kept.size() == most) break;
  }
  return kept;
}

/// Makes few candidates of many poses.
class CandidateRefiner {
 public:
  /// Of more than `most` candidates the best are kept.
  CandidateRefiner(std::size_t most, const PoseRefinement& refinement,
                   std::shared_ptr<const DistanceField> field, std::shared_ptr<const ContactIndex> contact);

  /// The distinct ones, each refined by the first 50 points of `sample` and judged anew by the contact of
  /// `points`; distinct again, as some may have become one.
  [[nodiscard]] std::vector<Candidate> refined(std::vector<Candidate> candidates,
                                               const Pose2& local_from_robot, const Points& sample,
                                               const Points& points) const;

 private:
  std::size_t most_;
  PoseRefinement refinement_;
  std::shared_ptr<const DistanceField> field_;
  std::shared_ptr<const ContactIndex> contact_;
};

/// At most n of the numbers below `below`, each once, in random order.
[[nodiscard]] std::vector<std::uint32_t> draw_numbers(std::size_t n, std::size_t below, Rng& rng);

/// At most n of the points, picked at random, in random order.
[[nodiscard]] Points sample_of(const Points& points, std::size_t n, Rng& rng);

}  // namespace glocal
