#include "raters/register.hpp"

#include "raters/best_fraction.hpp"
#include "raters/cluster_rating.hpp"
#include "raters/consecutive_rating.hpp"
#include "raters/exponential_threshold.hpp"
#include "raters/fixed_threshold.hpp"
#include "raters/quality_only.hpp"
#include "raters/quantile_threshold.hpp"
#include "raters/sliding_window.hpp"
#include "raters/softmax.hpp"
#include "raters/staged_margin.hpp"

namespace glocal {

void register_raters(Catalog& catalog) {
  catalog.raters.add<raters::ClusterRating>(
      "cluster_rating", "Size, spread and mean score of a cluster (eq. 7, 8).", stable_since("0.1.0"));
  catalog.raters.add<raters::QualityOnly>("quality_only", "The score of a cluster, whatever its size.",
                                          experimental_since("0.1.0"));
  catalog.raters.add<raters::Softmax>("softmax", "Differences in score, weighted exponentially.",
                                      experimental_since("0.1.0"));
  catalog.threshold_policies.add<raters::FixedThreshold>("fixed", "The same threshold in every step.",
                                                         stable_since("0.1.0"));
  catalog.threshold_policies.add<raters::SlidingWindow>(
      "sliding_window", "Mean hypothesis score over a sliding window (eq. 9).", stable_since("0.1.0"));
  catalog.threshold_policies.add<raters::ExponentialThreshold>(
      "exponential", "Mean hypothesis score, of which older steps count ever less.",
      experimental_since("0.1.0"));
  catalog.threshold_policies.add<raters::QuantileThreshold>(
      "quantile", "A quantile of the last step's scores.", experimental_since("0.1.0"));
  catalog.threshold_policies.add<raters::BestFraction>(
      "best_fraction", "A fraction of the best score, of the last step or so far.",
      experimental_since("0.1.0"));
  catalog.verdict_rules.add<raters::ConsecutiveRating>(
      "consecutive_rating", "The same cluster rated highly in consecutive steps (Section IV).",
      stable_since("0.1.0"));
  catalog.verdict_rules.add<raters::StagedMargin>(
      "staged_margin",
      "The best pose keeps its margin over all rivals for long enough: the clearer, the sooner.",
      stable_since("0.1.0"));
}

}  // namespace glocal
