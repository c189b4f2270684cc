#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// Omega_max as a quantile of the last step's qualities: only the better part of as good a step would pass.
/// As all of them are above the threshold of their step, it never falls while there are any; a step without
/// lowers it to a share of itself.
class QuantileThreshold final : public ThresholdPolicy {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double quantile = 0.25;
    double initial = 0.5;
  };

  explicit QuantileThreshold(const Params& params) : params_(params), omega_max_(params.initial) {}
  [[nodiscard]] double omega_max() const override { return omega_max_; }
  void update(const std::vector<Hypothesis>& hypotheses) override;
  void reset() override { omega_max_ = params_.initial; }

 private:
  Params params_;
  double omega_max_;
};
void describe(ParamVisitor& v, QuantileThreshold::Params& p);

}  // namespace glocal::raters
