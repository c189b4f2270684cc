#include "matchers/grid_search/branch_and_bound.hpp"

#include "matchers/grid_search/grid_search.hpp"
#include "matchers/grid_search/space_branch_and_bound.hpp"

namespace glocal {

std::unique_ptr<Matcher> BranchAndBound::make(const Params& params, const StageSetup& setup) {
  if (setup.motion == Motion::planar) return std::make_unique<BranchAndBound>(params, setup);
  return std::make_unique<SpaceBranchAndBound>(params, setup);
}

BranchAndBound::BranchAndBound(const Params& params, const StageSetup& setup)
    : GridMatcher(params, setup, contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      threads_(setup.threads),
      pyramid_(contact_pyramid(*setup.map, params.cell, setup.epsilon(params.contact_epsilon))) {}

GridSearchResult BranchAndBound::search(const Points& points, const Pose2& local_from_robot,
                                        const GridSearchRule& rule) const {
  return search_grid(*pyramid_, points, local_from_robot, rule, threads_);
}

}  // namespace glocal
