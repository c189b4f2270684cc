#include "raters/sliding_window.hpp"

#include <algorithm>
#include <numeric>

#include "raters/mean_score.hpp"

namespace glocal::raters {

void describe(ParamVisitor& v, SlidingWindow::Params& p) {
  v.field("window", p.window,
          {.doc = "Steps averaged (tau in eq. 9).", .min = 1, .max = 100000, .audience = Audience::tuner});
  v.field(
      "initial", p.initial,
      {.doc =
           "Omega_max before the first step: about 0.6 in a world that is as the map says, 0.5 on real logs.",
       .min = 0.0,
       .max = 1.0,
       .audience = Audience::tuner});
}

SlidingWindow::SlidingWindow(const Params& params) : params_(params) {
  reset();
}

double SlidingWindow::omega_max() const {
  const double sum = std::accumulate(means_.begin(), means_.end(), 0.0);
  // Not above the largest by rounding, as no score would reach a threshold above equal ones.
  return std::min(sum / static_cast<double>(means_.size()), std::ranges::max(means_));
}

void SlidingWindow::update(const std::vector<Hypothesis>& hypotheses) {
  means_.pop_front();
  means_.push_back(mean_score(hypotheses));
}

void SlidingWindow::reset() {
  means_.assign(static_cast<std::size_t>(params_.window), params_.initial);
}

}  // namespace glocal::raters
