#include "raters/mean_score.hpp"

namespace glocal::raters {
namespace {

/// A mean with weights; 0 of nothing.
struct Mean {
  double sum = 0.0;
  double weight = 0.0;

  void add(const Hypothesis& h) {
    sum += static_cast<double>(h.support) * h.score;
    weight += static_cast<double>(h.support);
  }
  [[nodiscard]] double value() const { return weight > 0.0 ? sum / weight : 0.0; }
};

}  // namespace

double mean_score(const std::vector<Hypothesis>& hypotheses) {
  Mean mean;
  for (const Hypothesis& h : hypotheses) mean.add(h);
  return mean.value();
}

double mean_score(const std::vector<Hypothesis>& hypotheses, std::span<const std::size_t> members) {
  Mean mean;
  for (const std::size_t i : members) mean.add(hypotheses[i]);
  return mean.value();
}

}  // namespace glocal::raters
