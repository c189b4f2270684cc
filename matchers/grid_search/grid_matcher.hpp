#pragma once

#include <memory>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/box_search/search_boxes.hpp"
#include "matchers/common/candidates.hpp"

namespace glocal::grid_search {

/// Which grid of poses is searched.
struct GridRule {
  std::optional<double> contact_epsilon = {};
  double cell = 0.05;
  /// Smallest step between rotations; a step moves the farthest point by one cell otherwise. A parameter of
  /// exhaustive only.
  double min_rotation_step_deg = 0.3;
  int max_points = 200;
  int max_poses = 50;

  /// By how many points a local map is searched for.
  [[nodiscard]] std::size_t most_points() const;
  /// For poses that bring this share of so many points into contact.
  [[nodiscard]] BoxSearchRule search_rule(double share, std::size_t points, const PoseGate& gate) const;
};
/// Among the fields of a matcher, not in a group of their own.
void describe(ParamVisitor& v, GridRule& p);

/// Which grid of poses is searched, and what becomes of the poses found.
struct GridMatching {
  GridRule grid = {};
  PoseRefinement refinement = {};  ///< Without iterations poses stay on the grid. Not in YAML.
};

/// Matching in the plane by a search of a grid of poses (PoseGrid). A local map of more than max_points is
/// searched for by a sample of them.
///
/// Hypotheses are the distinct poses (candidates) of what was found. Refined ones, as they are by default,
/// have left the grid, and are scored by what all points say (Omega, eq. 4); without iterations of refinement
/// they are poses of the grid, scored by it. A pose that only refinement would bring over Omega_max is not
/// found.
class GridMatcher : public Matcher {
 public:
  /// `contact` judges hypotheses. Throws ConfigError where the map is too large for a distance field.
  GridMatcher(const GridMatching& params, const StageSetup& setup,
              std::shared_ptr<const ContactIndex> contact);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) final;
  void reset() final {}

 protected:
  [[nodiscard]] const ContactIndex& contact() const { return *contact_; }

 private:
  [[nodiscard]] virtual BoxSearchResult search(const Points& points, const Pose3& local_from_robot,
                                               const BoxSearchRule& rule) const = 0;

  GridMatching params_;
  std::shared_ptr<const ContactIndex> contact_;
  CandidateRefiner refiner_;
};

}  // namespace glocal::grid_search
