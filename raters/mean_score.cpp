#include "raters/mean_score.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace glocal::raters {

double mean_score(const std::vector<Hypothesis>& hypotheses) {
  std::vector<std::size_t> all(hypotheses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return mean_score(hypotheses, all);
}

double mean_score(const std::vector<Hypothesis>& hypotheses, std::span<const std::size_t> members) {
  double sum = 0.0;
  double weight = 0.0;
  double largest = 0.0;
  for (const std::size_t i : members) {
    const auto support = static_cast<double>(hypotheses[i].support);
    sum += support * hypotheses[i].score;
    weight += support;
    largest = std::max(largest, hypotheses[i].score);
  }
  // By rounding, a mean of equal scores may be above them: a threshold that none of them reaches.
  return weight > 0.0 ? std::min(sum / weight, largest) : 0.0;
}

}  // namespace glocal::raters
