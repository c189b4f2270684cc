#include "raters/share_of_best.hpp"

#include <algorithm>

namespace glocal::raters {

void describe(ParamVisitor& v, ShareOfBest::Params& p) {
  v.field(
      "share", p.share,
      {.doc = "Share of the last step's best score that a hypothesis must reach.", .min = 0.0, .max = 1.0});
  v.field("least", p.least, {.doc = "Omega_max is at least this.", .min = 0.0, .max = 1.0});
}

double ShareOfBest::omega_max() const {
  return std::max(params_.least, params_.share * best_);
}

void ShareOfBest::update(const std::vector<Hypothesis>& hypotheses) {
  best_ = hypotheses.empty() ? 0.0 : hypotheses.front().score;
}

}  // namespace glocal::raters
