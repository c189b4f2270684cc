#include "raters/register.hpp"

#include "raters/cluster_rating.hpp"
#include "raters/consecutive_rating.hpp"
#include "raters/sliding_window.hpp"

namespace glocal {

void register_raters(Catalog& catalog) {
  catalog.raters.add<ClusterRating>("cluster_rating", "Size, spread and quality of a cluster (eq. 7, 8).");
  catalog.threshold_policies.add<SlidingWindow>("sliding_window",
                                                "Mean hypothesis quality over a sliding window (eq. 9).");
  catalog.verdict_rules.add<ConsecutiveRating>(
      "consecutive_rating", "The same cluster rated highly in consecutive steps (Section IV).");
}

}  // namespace glocal
