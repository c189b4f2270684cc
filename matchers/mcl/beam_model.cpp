#include "matchers/mcl/beam_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glocal::mcl {
namespace {

/// The part of a standard normal distribution below x.
double normal_below(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// eq. 6.4 to 6.6: normal about the expected range, cut off at 0 and at the largest range.
double hit(double measured, double expected, const BeamModelRule& rule) {
  const double deviations = (measured - expected) / rule.sigma_hit;
  const double inside =
      normal_below((rule.max_range - expected) / rule.sigma_hit) - normal_below(-expected / rule.sigma_hit);
  const double height = 1.0 / (rule.sigma_hit * std::sqrt(2.0 * std::numbers::pi));
  return height * std::exp(-0.5 * deviations * deviations) / inside;
}

/// eq. 6.7 to 6.9: things in the way, the more likely the nearer.
double too_short(double measured, double expected, const BeamModelRule& rule) {
  if (measured > expected || expected <= 0.0) return 0.0;
  const double all = 1.0 - std::exp(-rule.lambda_short * expected);
  return rule.lambda_short * std::exp(-rule.lambda_short * measured) / all;
}

}  // namespace

double beam_likelihood(double measured, double expected, const BeamModelRule& rule) {
  const double weights = rule.z_hit + rule.z_short + rule.z_max + rule.z_rand;
  const bool meets_nothing = expected >= rule.max_range;
  if (measured >= rule.max_range) {
    // Where nothing is to be met, to meet nothing is the hit.
    return (rule.z_max + (meets_nothing ? rule.z_hit : 0.0)) / weights;
  }
  const double hits = meets_nothing ? 0.0 : rule.z_hit * hit(measured, expected, rule);
  const double shorts = rule.z_short * too_short(measured, std::min(expected, rule.max_range), rule);
  return (hits + shorts + rule.z_rand / rule.max_range) / weights;
}

}  // namespace glocal::mcl
