#include "raters/register.hpp"

#include "raters/cluster_rating.hpp"
#include "raters/consecutive_rating.hpp"
#include "raters/fixed_threshold.hpp"
#include "raters/sliding_window.hpp"
#include "raters/staged_margin.hpp"

namespace glocal {

void register_raters(Catalog& catalog) {
  catalog.raters.add<ClusterRating>("cluster_rating", "Size, spread and quality of a cluster (eq. 7, 8).");
  catalog.threshold_policies.add<FixedThreshold>("fixed", "The same quality in every step.");
  catalog.threshold_policies.add<SlidingWindow>("sliding_window",
                                                "Mean hypothesis quality over a sliding window (eq. 9).");
  catalog.verdict_rules.add<ConsecutiveRating>(
      "consecutive_rating", "The same cluster rated highly in consecutive steps (Section IV).");
  catalog.verdict_rules.add<StagedMargin>(
      "staged_margin", "The best pose leads its rivals for long enough: the clearer, the sooner.");
}

}  // namespace glocal
