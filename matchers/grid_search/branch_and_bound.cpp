#include "matchers/grid_search/branch_and_bound.hpp"

#include "matchers/grid_search/grid_search.hpp"

namespace glocal {

BranchAndBound::BranchAndBound(const Params& params, const StageSetup& setup)
    : GridMatcher(params, *setup.map,
                  contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      threads_(setup.threads),
      pyramid_(contact_pyramid(*setup.map, params.cell, setup.epsilon(params.contact_epsilon))) {}

GridSearchResult BranchAndBound::search(const Points& points, const Pose2& local_from_robot,
                                        const GridSearchRule& rule) const {
  return search_grid(*pyramid_, points, local_from_robot, rule, threads_);
}

}  // namespace glocal
