#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

/// Omega_max as a share of the best quality of the last step. A step without hypotheses lets it fall to
/// `least`.
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
  double best_ = 0.0;  ///< Best quality of the last step.
};
void describe(ParamVisitor& v, ShareOfBest::Params& p);

}  // namespace glocal
