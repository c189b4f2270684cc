#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// Omega_max as an exponential moving average of the steps' mean hypothesis qualities (Roberts 1959), where
/// eq. 9 has a window: the latest step counts most, and none drops out at once. A step without hypotheses
/// counts as 0, as in eq. 9.
class ExponentialThreshold final : public ThresholdPolicy {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double weight = 0.1;
    double initial = 0.6;
  };

  explicit ExponentialThreshold(const Params& params) : params_(params), omega_max_(params.initial) {}
  [[nodiscard]] double omega_max() const override { return omega_max_; }
  void update(const std::vector<Hypothesis>& hypotheses) override;
  void reset() override { omega_max_ = params_.initial; }

 private:
  Params params_;
  double omega_max_;
};
void describe(ParamVisitor& v, ExponentialThreshold::Params& p);

}  // namespace glocal::raters
