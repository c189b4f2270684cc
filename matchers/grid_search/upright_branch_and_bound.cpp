#include "matchers/grid_search/upright_branch_and_bound.hpp"

#include <algorithm>

#include "matchers/box_search/search_boxes.hpp"

namespace glocal::grid_search {

UprightBranchAndBound::UprightBranchAndBound(const Params& params, const StageSetup& setup)
    : params_(params),
      threads_(setup.threads),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      pyramid_(box_pyramid(BoxPyramid::Of::pose_grid, *setup.map, params.cell,
                           setup.epsilon(params.contact_epsilon), setup.motion, setup.threads)) {}

MatchResult UprightBranchAndBound::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  MatchResult result;
  if (local.points.empty()) return result;
  const Points sample = sample_of(local.points, params_.most_points(), rng);
  const BoxSearchResult search_result = search_boxes(
      *pyramid_, sample, local.local_from_robot,
      params_.search_rule(request.omega_max, sample.size(), request.gate), std::nullopt, threads_);
  result.proposals = search_result.tested;
  result.points_tested = search_result.looks;
  for (const BoxSearchResult::FoundPose& pose : search_result.poses) {
    const Pose3 map_from_local = pose.pose();
    const Pose3 robot = map_from_local * local.local_from_robot;
    // Neighbours of a better pose that lie in another cell of robot poses.
    const bool is_known = std::ranges::any_of(result.hypotheses, [&](const Hypothesis& h) {
      return is_same_candidate(robot, h.map_from_local * local.local_from_robot);
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

}  // namespace glocal::grid_search
