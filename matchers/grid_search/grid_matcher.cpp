#include "matchers/grid_search/grid_matcher.hpp"

#include <utility>

#include "matchers/grid_search/contact_pyramid.hpp"

namespace glocal {

void describe(ParamVisitor& v, GridMatching& p) {
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("cell", p.cell,
          {.doc = "Translations are multiples of this; at most contact_epsilon.",
           .unit = "m",
           .min = 0.01,
           .max = 1.0,
           .audience = Audience::tuner});
  v.require(!p.contact_epsilon || p.cell <= *p.contact_epsilon, "cell", "must be at most contact_epsilon");
  v.field("min_rotation_step_deg", p.min_rotation_step_deg,
          {.doc = "Smallest step between rotations; a step moves the farthest point by one cell otherwise.",
           .unit = "deg",
           .min = 0.005,
           .max = 5.7,
           .audience = Audience::expert,
           .formerly = "min_rotation_step"});
  v.field("max_points", p.max_points,
          {.doc = "A local map of more points is searched for by a random sample of so many; 0 takes all.",
           .min = 0,
           .max = static_cast<double>(TileCounts::most_points),
           .audience = Audience::tuner});
  v.field("max_poses", p.max_poses,
          {.doc = "Number of poses searched for: the best, one in each cell of candidate_distance (its "
                  "diagonal) and candidate_rotation_deg. Fewer take less time.",
           .min = 1,
           .max = 100000,
           .audience = Audience::tuner});
  describe(v, p.candidate);
  v.field("refinement", p.refinement,
          {.doc = "How poses are refined on the distance field, in the plane; without iterations they stay "
                  "on the grid.",
           .audience = Audience::expert});
}

std::size_t most_points(const GridMatching& p) {
  return p.max_points > 0 ? static_cast<std::size_t>(p.max_points) : TileCounts::most_points;
}

GridSearchRule search_rule(const GridMatching& p, double omega_max, const PoseGate& gate) {
  return {.min_quality = omega_max,
          .min_rotation_step = radians(p.min_rotation_step_deg),
          .distance = p.candidate.distance,
          .rotation = radians(p.candidate.rotation_deg),
          .max_poses = static_cast<std::size_t>(p.max_poses),
          .gate = gate};
}

GridMatcher::GridMatcher(const GridMatching& params, const StageSetup& setup,
                         std::shared_ptr<const ContactIndex> contact)
    : params_(params),
      contact_(std::move(contact)),
      refiner_(params.candidate, static_cast<std::size_t>(params.max_poses), params.refinement,
               distance_field(*setup.map, setup.threads), contact_) {}

MatchResult GridMatcher::match(const LocalMap& local, const Observation& /*latest*/, double omega_max,
                               Rng& rng) {
  MatchResult result;
  if (local.points.empty()) return result;
  const Points sample = sample_of(local.points, most_points(params_), rng);
  const Pose2 local_from_robot = seen_from_above(local.local_from_robot);
  const GridSearchResult found = search(sample, local_from_robot, search_rule(params_, omega_max, gate_));
  result.proposals = found.tested;
  result.points_tested = found.points_tested;
  std::vector<Candidate> candidates;
  for (const GridSearchResult::Pose& pose : found.poses) {
    candidates.push_back(
        {pose.map_from_local, static_cast<double>(pose.in_contact) / static_cast<double>(sample.size())});
  }
  candidates = distinct_candidates(std::move(candidates), local_from_robot, params_.candidate,
                                   static_cast<std::size_t>(params_.max_poses));
  if (params_.refinement.iterations > 0) {
    result.points_tested += candidates.size() * local.points.size();
    candidates = refiner_.refined(std::move(candidates), local_from_robot, sample, local.points);
  }
  for (const Candidate& candidate : candidates) {
    if (candidate.quality < omega_max) break;
    result.hypotheses.push_back(
        {.map_from_local = candidate.map_from_local,
         .quality = contact_->share(local.points, Transform(candidate.map_from_local)),
         .score = candidate.quality});
  }
  return result;
}

}  // namespace glocal
