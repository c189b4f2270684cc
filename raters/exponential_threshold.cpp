#include "raters/exponential_threshold.hpp"

#include <algorithm>

#include "raters/mean_score.hpp"

namespace glocal::raters {

void describe(ParamVisitor& v, ExponentialThreshold::Params& p) {
  v.field("weight", p.weight,
          {.doc = "Share of the latest step; 2 / (n + 1) is about as slow as a window of n steps.",
           .max = 1.0,
           .above = 0.0,
           .audience = Audience::tuner});
  v.field("initial", p.initial,
          {.doc = "Omega_max before the first step.", .min = 0.0, .max = 1.0, .audience = Audience::tuner});
}

void ExponentialThreshold::update(const std::vector<Hypothesis>& hypotheses) {
  const double mean = mean_score(hypotheses);
  const auto [low, high] = std::minmax({omega_max_, mean});
  // Not beyond either by rounding, as no score would reach a threshold above both.
  omega_max_ = std::clamp(omega_max_ + params_.weight * (mean - omega_max_), low, high);
}

}  // namespace glocal::raters
