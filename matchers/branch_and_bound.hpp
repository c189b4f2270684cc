#pragma once

#include <memory>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/contact_pyramid.hpp"
#include "matchers/distance_field.hpp"
#include "matchers/modes.hpp"

namespace glocal {

/// Exact matching on a grid of poses: what it does not find is not there.
///
/// A pose of the grid turns the local map by whole steps about its middle and moves it by whole cells
/// (PoseGrid). It is as good as the share of points that come to lie in a cell in contact: one whose centre
/// is within contact_epsilon of a point of the map. That differs from eq. 4 only for points whose distance is
/// within half a cell's diagonal of contact_epsilon. Exact means: among all poses of the grid that bring any
/// point and the share Omega_max into contact, none that is better than the best hypothesis has been missed,
/// and each is within 2 mode_distance and 2 mode_rotation of a hypothesis at least as good; up to max_poses
/// (search_grid). A local map of more than max_points is searched for by a sample of them.
///
/// Hypotheses are the distinct poses (modes) of what was found. Refined ones, as they are by default, have
/// left the grid, and are as good as all points say (Omega, eq. 4); without iterations of refinement they are
/// poses of the grid, with its quality. A pose that only refinement would bring over Omega_max is not found.
///
/// `checks` counts looks at a point, each of which serves 512 neighbouring translations; `collisions` the
/// poses of the grid whose points were counted.
class BranchAndBound final : public Matcher {
 public:
  struct Params {
    double contact_epsilon = 0.10;
    double cell = 0.05;
    double min_rotation_step = 0.005;
    int max_points = 200;
    int max_poses = 50;
    double mode_distance = 0.4;
    double mode_rotation = 0.2;
    int refinement_points = 50;
    PoseRefinement refinement = {};
    double field_cell = 0.05;
  };

  /// Throws ConfigError where the map is too large for a contact grid, a pyramid or a distance field.
  BranchAndBound(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const LocalMap& local, const Observation& latest, double omega_max,
                                  Rng& rng) override;
  void reset() override {}

 private:
  [[nodiscard]] std::vector<Mode> distinct(std::vector<Mode> modes, const Pose2& local_from_robot) const;

  Params params_;
  int threads_;
  std::shared_ptr<const ContactPyramid> pyramid_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const DistanceField> field_;
};
void describe(ParamVisitor& v, BranchAndBound::Params& p);

}  // namespace glocal
