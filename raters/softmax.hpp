#pragma once

#include <string>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// r = exp(beta (score - 1)), so that the normalised ratings (eq. 8) are the softmax of beta times the
/// scores (Bridle 1990): what counts are differences in score, and one clearly better cluster outweighs
/// many others. With beta = n log(1 / eta) that is a posterior over poses in which each of n points that has
/// no contact is eta times as likely as one that has.
class Softmax final : public Rater {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double beta = 30.0;
    std::string quality = "best";
  };

  explicit Softmax(const Params& params) : params_(params) {}
  [[nodiscard]] std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                                         const std::vector<Hypothesis>& hypotheses) override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, Softmax::Params& p);

}  // namespace glocal::raters
