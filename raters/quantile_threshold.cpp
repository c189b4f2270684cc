#include "raters/quantile_threshold.hpp"

#include <algorithm>

namespace glocal::raters {
namespace {

/// What a step without hypotheses leaves of Omega_max.
constexpr double share_left_by_nothing = 0.9;

/// The least score such that hypotheses of at most that score have a share `quantile` of all support.
/// They come in falling score, and are not empty.
double score_at(double quantile, const std::vector<Hypothesis>& hypotheses) {
  double all = 0.0;
  for (const Hypothesis& h : hypotheses) all += static_cast<double>(h.support);
  double so_far = 0.0;
  for (auto h = hypotheses.rbegin(); h != hypotheses.rend(); ++h) {
    so_far += static_cast<double>(h->support);
    if (so_far >= quantile * all) return h->score;
  }
  return hypotheses.front().score;
}

}  // namespace

void describe(ParamVisitor& v, QuantileThreshold::Params& p) {
  v.field("quantile", p.quantile,
          {.doc = "Share of the last step's hypotheses, by support, that Omega_max leaves behind: 0 is the "
                  "lowest score, 1 the best.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::tuner});
  v.field("initial", p.initial,
          {.doc = "Omega_max before the first step.", .min = 0.0, .max = 1.0, .audience = Audience::tuner});
}

void QuantileThreshold::update(const std::vector<Hypothesis>& hypotheses) {
  omega_max_ = hypotheses.empty() ? share_left_by_nothing * omega_max_
                                  : std::clamp(score_at(params_.quantile, hypotheses), 0.0, 1.0);
}

}  // namespace glocal::raters
