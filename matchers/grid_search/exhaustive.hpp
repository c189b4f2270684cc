#pragma once

#include "matchers/box_search/best_places.hpp"
#include "matchers/box_search/pose_boxes.hpp"
#include "matchers/grid_search/grid_matcher.hpp"

namespace glocal::grid_search {

/// Brute force: looks at every pose of the grid that branch_and_bound searches, and judges each by the
/// contact of its points where they really lie (Omega, eq. 4). Slow, and with nothing in it that could go
/// wrong: what other matchers are measured by, on small maps.
///
/// Of the poses, the best max_poses become candidates, one in each cell of candidate_distance and
/// candidate_rotation. A pose is left as soon as too few points remain to make it one of them; no pose is
/// skipped by guess. With `contact: kd_tree` quality is exact, with `bitset` up to half a voxel.
///
/// `points_tested` counts looks at a point; `proposals` the poses of the grid, all of which are tested.
class Exhaustive final : public GridMatcher {
 public:
  struct Params {
    GridMatching matching = {};
    ContactChoice contact = "bitset";
  };

  /// Throws ConfigError where the map is too large for a contact grid or a distance field.
  Exhaustive(const Params& params, const StageSetup& setup);

 private:
  [[nodiscard]] BoxSearchResult search(const Points& points, const Pose3& local_from_robot,
                                       const BoxSearchRule& rule) const override;
  [[nodiscard]] FoundPlaces search_rotation(const PoseGrid& grid, std::size_t rotation, const Points& points,
                                            const Pose3& local_from_robot, const BoxSearchRule& rule,
                                            std::size_t least) const;

  int threads_;
  CellFrame frame_;
};
void describe(ParamVisitor& v, Exhaustive::Params& p);

}  // namespace glocal::grid_search
