#include "matchers/grid_search/space_branch_and_bound.hpp"

#include <algorithm>

#include "matchers/grid_search/grid_search.hpp"

namespace glocal {

SpaceBranchAndBound::SpaceBranchAndBound(const GridMatching& params, const StageSetup& setup)
    : params_(params),
      threads_(setup.threads),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      pyramid_(
          contact_pyramid(*setup.map, params.cell, setup.epsilon(params.contact_epsilon), setup.motion)) {}

MatchResult SpaceBranchAndBound::match(const LocalMap& local, const Observation& /*latest*/, double omega_max,
                                       Rng& rng) {
  MatchResult result;
  if (local.points.empty()) return result;
  const Points sample = sample_of(local.points, most_points(params_), rng);
  const GridSearchResult found =
      search_grid(*pyramid_, sample, seen_from_above(local.local_from_robot),
                  search_rule(params_, omega_max, gate_), threads_, local.local_from_robot.z);
  result.proposals = found.tested;
  result.points_tested = found.points_tested;
  for (const GridSearchResult::Pose& pose : found.poses) {
    const Pose2& above = pose.map_from_local;
    const Pose3 map_from_local({above.x, above.y, pose.z}, turn_about_z(above.theta));
    const Pose3 robot = map_from_local * local.local_from_robot;
    // Neighbours of a better pose that lie in another cell of robot poses.
    const bool is_known =
        std::any_of(result.hypotheses.begin(), result.hypotheses.end(), [&](const Hypothesis& h) {
          const Pose3 other = h.map_from_local * local.local_from_robot;
          return distance(robot, other) < params_.candidate.distance &&
                 rotation_between(robot, other) < radians(params_.candidate.rotation_deg);
        });
    if (is_known) continue;
    const double omega = contact_->share(local.points, map_from_local);
    result.points_tested += local.points.size();
    result.hypotheses.push_back(
        {.map_from_local = map_from_local,
         .quality = omega,
         .score = static_cast<double>(pose.in_contact) / static_cast<double>(sample.size())});
  }
  return result;
}

}  // namespace glocal
