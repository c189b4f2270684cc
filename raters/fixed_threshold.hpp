#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// The same Omega_max in every step.
class FixedThreshold final : public ThresholdPolicy {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double omega_max = 0.2;
  };

  explicit FixedThreshold(const Params& params) : params_(params) {}
  [[nodiscard]] double omega_max() const override { return params_.omega_max; }
  void update(const std::vector<Hypothesis>& /*hypotheses*/) override {}
  void reset() override {}

 private:
  Params params_;
};

inline void describe(ParamVisitor& v, FixedThreshold::Params& p) {
  v.field("omega_max", p.omega_max, {.doc = "Score a hypothesis must reach.", .min = 0.0, .max = 1.0});
}

}  // namespace glocal::raters
