#pragma once

#include <string>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// Omega_max as a fraction of the best score, of the last step or so far: how good the best pose is depends
/// on how well map and world agree, and a wrong pose is judged against that. A step without hypotheses leaves
/// a share of the best score and of the threshold.
class BestFraction final : public ThresholdPolicy {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double fraction = 0.8;
    std::string best = "last_step";
    double initial = 0.5;
  };

  explicit BestFraction(const Params& params) : params_(params), omega_max_(params.initial) {}
  [[nodiscard]] double omega_max() const override { return omega_max_; }
  void update(const std::vector<Hypothesis>& hypotheses) override;
  void reset() override;

 private:
  Params params_;
  double best_ = 0.0;
  double omega_max_;
};
void describe(ParamVisitor& v, BestFraction::Params& p);

}  // namespace glocal::raters
