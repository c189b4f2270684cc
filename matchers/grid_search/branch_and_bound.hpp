#pragma once

#include <memory>

#include "matchers/box_search/box_pyramid.hpp"
#include "matchers/grid_search/grid_matcher.hpp"

namespace glocal::grid_search {

/// Exact matching on a grid of poses: what it does not find is not there.
///
/// A pose of the grid is as good as the share of points that come to lie in a cell in contact: one whose
/// centre is within contact_epsilon of a point of the map. That differs from eq. 4 only for points whose
/// distance is within half a cell's diagonal of contact_epsilon. Exact means: among all poses of the grid
/// that bring any point and the share Omega_max into contact, none that is better than the best hypothesis
/// has been missed, and each is within 2 candidate_distance and 2 candidate_rotation of a hypothesis at least
/// as good; up to max_poses (search_boxes).
///
/// `points_tested` counts looks at a point, each of which serves 512 neighbouring translations; `proposals`
/// the poses of the grid whose points were counted.
class BranchAndBound final : public GridMatcher {
 public:
  using Params = GridMatching;  // Its grid is in YAML.

  /// Throws ConfigError where the map is too large for a contact grid, a pyramid or a distance field.
  BranchAndBound(const Params& params, const StageSetup& setup);

 private:
  [[nodiscard]] BoxSearchResult search(const Points& points, const Pose3& local_from_robot,
                                       const BoxSearchRule& rule) const override;

  int threads_;
  std::shared_ptr<const BoxPyramid> pyramid_;
};
void describe(ParamVisitor& v, BranchAndBound::Params& p);

}  // namespace glocal::grid_search
