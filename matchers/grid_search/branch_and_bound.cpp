#include "matchers/grid_search/branch_and_bound.hpp"

namespace glocal::grid_search {

void describe(ParamVisitor& v, BranchAndBound::Params& p) {
  describe(v, p.grid);
}

BranchAndBound::BranchAndBound(const Params& params, const StageSetup& setup)
    : GridMatcher(params, setup,
                  contact_index(*setup.map, "bitset", setup.epsilon(params.grid.contact_epsilon))),
      threads_(setup.threads),
      pyramid_(box_pyramid(BoxPyramid::Of::pose_grid, *setup.map, params.grid.cell,
                           setup.epsilon(params.grid.contact_epsilon), Motion::planar, setup.threads)) {}

BoxSearchResult BranchAndBound::search(const Points& points, const Pose3& local_from_robot,
                                       const BoxSearchRule& rule) const {
  return search_boxes(*pyramid_, points, local_from_robot, rule, std::nullopt, threads_);
}

}  // namespace glocal::grid_search
