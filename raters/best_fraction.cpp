#include "raters/best_fraction.hpp"

#include <algorithm>

namespace glocal::raters {
namespace {

/// What a step without hypotheses leaves of the best score and of Omega_max.
constexpr double empty_share = 0.9;

}  // namespace

void describe(ParamVisitor& v, BestFraction::Params& p) {
  v.field("fraction", p.fraction,
          {.doc = "Omega_max is this fraction of the best score.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::tuner});
  v.field("best", p.best,
          {.doc = "Which score is the best: that of the last step, or the best so far.",
           .choices = {"last_step", "so_far"}});
  v.field("initial", p.initial,
          {.doc = "Omega_max before the first step.", .min = 0.0, .max = 1.0, .audience = Audience::tuner});
}

void BestFraction::update(const std::vector<Hypothesis>& hypotheses) {
  if (hypotheses.empty()) {
    best_ *= empty_share;
    omega_max_ *= empty_share;
    return;
  }
  const double score = std::clamp(hypotheses.front().score, 0.0, 1.0);
  best_ = params_.best == "so_far" ? std::max(best_, score) : score;
  omega_max_ = params_.fraction * best_;
}

void BestFraction::reset() {
  best_ = 0.0;
  omega_max_ = params_.initial;
}

}  // namespace glocal::raters
