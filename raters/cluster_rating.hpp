#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// The paper's ratings: r from size, spread and mean score (eq. 7), and r normalised over the step's
/// clusters (eq. 8).
class ClusterRating final : public Rater {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    /// The paper leaves them open; these give its first-step ratings of 0.2 to 0.45 (Fig. 4a).
    std::vector<double> weights = {0.5, 0.075, 0.075, 0.35};
    double max_variance_translation = 0.0030;
  };

  explicit ClusterRating(const Params& params) : params_(params) {}
  [[nodiscard]] std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                                         const std::vector<Hypothesis>& hypotheses) override;

 private:
  [[nodiscard]] double rate_one(const Cluster& cluster, const std::vector<Hypothesis>& hypotheses,
                                double all_support) const;

  Params params_;
};
void describe(ParamVisitor& v, ClusterRating::Params& p);

}  // namespace glocal::raters
