// A search of the whole map, where draws do not settle the matter.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/hypothesis.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "matchers/common/candidates.hpp"
#include "matchers/grid_search/best_poses.hpp"
#include "matchers/grid_search/contact_pyramid.hpp"

namespace glocal {

/// When a search is due, and how fine it is.
struct ExactSearchRule {
  int after_steps = 0;
  double margin = 0.1;
  double cell = 0.05;
  double min_rotation_step_deg = 0.3;
  int max_poses = 50;
};
void describe(ParamVisitor& v, ExactSearchRule& p);

/// search_grid() for one matcher: for poses with a least contact, distinct by a candidate rule.
class ExactSearch {
 public:
  /// Throws ConfigError where the map is too large for a pyramid.
  ExactSearch(const ExactSearchRule& rule, const CandidateRule& candidate, double min_contact,
              const GlobalMap& map, double contact_epsilon, int threads);

  /// Takes in the best poses of a step: whether it is the last of so many in a row in which no pose is
  /// clearly the best. Then the count begins anew, as it does by reset().
  [[nodiscard]] bool is_due(const std::vector<Hypothesis>& best);
  void reset() { undecided_ = 0; }

  /// The best poses that are allowed in the whole map, by the contact of these points of a local map.
  [[nodiscard]] GridSearchResult search(const Points& points, const Pose2& local_from_robot,
                                        const PoseGate& gate) const;

 private:
  ExactSearchRule rule_;
  GridSearchRule grid_;
  std::shared_ptr<const ContactPyramid> pyramid_;  ///< Null where no search is ever due.
  int threads_;
  int undecided_ = 0;  ///< Steps without a clear best pose.
};

}  // namespace glocal
