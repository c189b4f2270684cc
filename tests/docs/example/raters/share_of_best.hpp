#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// Omega_max is a share of the best score of the last step. After a step without hypotheses it is `least`.
class ShareOfBest final : public ThresholdPolicy {
 public:
  struct Params {
    double share = 0.8;
    double least = 0.4;
  };

  explicit ShareOfBest(const Params& params) : params_(params) {}
  [[nodiscard]] double omega_max() const override;
  void update(const std::vector<Hypothesis>& hypotheses) override;
  void reset() override { best_ = 0.0; }

 private:
  Params params_;
  double best_ = 0.0;  ///< Best score of the last step.
};
void describe(ParamVisitor& v, ShareOfBest::Params& p);

}  // namespace glocal::raters
