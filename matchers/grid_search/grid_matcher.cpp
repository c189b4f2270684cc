#include "matchers/grid_search/grid_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glocal::grid_search {

void describe(ParamVisitor& v, GridRule& p) {
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("cell", p.cell,
          {.doc = "Translations are multiples of this; at most contact_epsilon.",
           .unit = "m",
           .min = 0.01,
           .max = 1.0,
           .audience = Audience::tuner});
  v.require(!p.contact_epsilon || p.cell <= *p.contact_epsilon, "cell", "must be at most contact_epsilon");
  v.field("max_points", p.max_points,
          {.doc = "A local map of more points is searched for by a random sample of so many; 0 takes all.",
           .min = 0,
           .max = static_cast<double>(TileCounts::most_points),
           .audience = Audience::tuner});
  v.field("max_poses", p.max_poses,
          {.doc = "Number of poses searched for: the best, one in each cell of 0.4 m (its "
                  "diagonal) and 11.5 degrees. Fewer take less time.",
           .min = 1,
           .max = 100000,
           .audience = Audience::tuner});
}

std::size_t GridRule::most_points() const {
  return max_points > 0 ? static_cast<std::size_t>(max_points) : TileCounts::most_points;
}

BoxSearchRule GridRule::search_rule(double share, std::size_t points, const PoseGate& gate) const {
  const auto n = static_cast<double>(points);
  auto least = static_cast<std::size_t>(std::max(1.0, std::floor(share * n)));
  while (static_cast<double>(least) / n < share) ++least;
  return {.least = least,
          .cell_distance = candidate_distance,
          .cell_rotation = candidate_rotation,
          .most_places = static_cast<std::size_t>(max_poses),
          .min_rotation_step = radians(min_rotation_step_deg),
          .gate = gate};
}

GridMatcher::GridMatcher(const GridMatching& params, const StageSetup& setup,
                         std::shared_ptr<const ContactIndex> contact)
    : params_(params),
      contact_(std::move(contact)),
      refiner_(static_cast<std::size_t>(params.grid.max_poses), params.refinement,
               distance_field(*setup.map, setup.threads), contact_) {}

MatchResult GridMatcher::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  MatchResult result;
  if (local.points.empty()) return result;
  const Points sample = sample_of(local.points, params_.grid.most_points(), rng);
  const Pose2 local_from_robot = seen_from_above(local.local_from_robot);
  const BoxSearchResult search_result =
      search(sample, local.local_from_robot,
             params_.grid.search_rule(request.omega_max, sample.size(), request.gate));
  result.proposals = search_result.tested;
  result.points_tested = search_result.looks;
  std::vector<Candidate> candidates;
  for (const BoxSearchResult::FoundPose& pose : search_result.poses) {
    candidates.push_back(
        {pose.map_from_local, static_cast<double>(pose.in_contact) / static_cast<double>(sample.size())});
  }
  candidates = distinct_candidates(std::move(candidates), local_from_robot,
                                   static_cast<std::size_t>(params_.grid.max_poses));
  if (params_.refinement.iterations > 0) {
    result.points_tested += candidates.size() * local.points.size();
    candidates = refiner_.refined(std::move(candidates), local_from_robot, sample, local.points);
  }
  for (const Candidate& candidate : candidates) {
    if (candidate.quality < request.omega_max) break;
    result.hypotheses.push_back(
        {.map_from_local = candidate.map_from_local,
         .quality = contact_->share(local.points, Transform(candidate.map_from_local)),
         .score = candidate.quality});
  }
  return result;
}

}  // namespace glocal::grid_search
