#pragma once

#include <deque>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// Omega_max as the mean, over a sliding window of steps, of each step's mean hypothesis score (eq. 9).
/// Steps before the first count as `initial`. A step without hypotheses counts as 0: every hypothesis lies
/// above the threshold of its step, so only empty steps let the threshold fall.
class SlidingWindow final : public ThresholdPolicy {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    int window = 10;
    double initial = 0.6;
  };

  explicit SlidingWindow(const Params& params);
  [[nodiscard]] double omega_max() const override;
  void update(const std::vector<Hypothesis>& hypotheses) override;
  void reset() override;

 private:
  Params params_;
  std::deque<double> means_;  ///< Always `window` of them.
};
void describe(ParamVisitor& v, SlidingWindow::Params& p);

}  // namespace glocal::raters
