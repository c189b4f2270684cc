// Distinct poses among many that mean nearly the same.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"

namespace glocal {

/// A pose of the local map, and how good it looks so far.
struct Candidate {
  Pose2 map_from_local;
  double quality = 0.0;
};

/// When two robot poses are one candidate, both nearer and turned by less; and how many points refine one.
struct CandidateRule {
  double distance = 0.4;  ///< m
  double rotation_deg = 11.5;
  int refinement_points = 50;
};
/// Among the fields of a matcher, not in a group of their own.
void describe(ParamVisitor& v, CandidateRule& p);

/// Of robot poses in the plane (Pose2) or in space (Pose3).
template <class Pose>
[[nodiscard]] bool is_same_candidate(const Pose& a, const Pose& b, const CandidateRule& rule) {
  return distance(a, b) < rule.distance && rotation_between(a, b) < radians(rule.rotation_deg);
}

/// The best first, at most `most`, leaving out those that only repeat a better one: the same robot pose.
/// A candidate has a `map_from_local` and a `quality`.
template <class Candidate, class Pose>
[[nodiscard]] std::vector<Candidate> distinct_candidates(std::vector<Candidate> candidates,
                                                         const Pose& local_from_robot,
                                                         const CandidateRule& rule, std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.quality > b.quality; });
  std::vector<Candidate> kept;
  std::vector<Pose> robots;
  for (const Candidate& candidate : candidates) {
    const Pose robot = candidate.map_from_local * local_from_robot;
    const bool repeats = std::any_of(robots.begin(), robots.end(), [&](const Pose& other) {
      return is_same_candidate(robot, other, rule);
    });
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
  CandidateRefiner(const CandidateRule& rule, std::size_t most, const PoseRefinement& refinement,
                   std::shared_ptr<const DistanceField> field, std::shared_ptr<const ContactIndex> contact);

  /// The distinct ones, each refined by the first points of `sample` and judged anew by the contact of
  /// `points`; distinct again, as some may have become one.
  [[nodiscard]] std::vector<Candidate> refined(std::vector<Candidate> candidates,
                                               const Pose2& local_from_robot, const Points& sample,
                                               const Points& points) const;

 private:
  CandidateRule rule_;
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
