#pragma once

#include <memory>

#include "glocal/contact.hpp"
#include "glocal/strategies.hpp"
#include "matchers/box_search/box_pyramid.hpp"
#include "matchers/grid_search/grid_matcher.hpp"

namespace glocal::grid_search {

/// Exact matching on a grid of upright poses: x, y, z and yaw. What it does not find is not there, as long as
/// the robot is between the map's lowest and highest points.
///
/// As in the plane, a pose of the grid is as good as the share of points that come to lie in a cell whose
/// centre is within contact_epsilon of a point of the map; cells are cubes. Poses stay on the grid. Their
/// score is that share, their quality Omega (eq. 4) of all points.
class UprightBranchAndBound final : public Matcher {
 public:
  using Params = GridRule;
  static constexpr Motions motions{.planar = false, .upright = true};

  /// Throws ConfigError where the map is too large for a contact grid or a pyramid.
  UprightBranchAndBound(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override {}

 private:
  GridRule params_;
  int threads_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const BoxPyramid> pyramid_;
};

}  // namespace glocal::grid_search
