#include "evaluation/statistics/ranks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glocal {

Ranks ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  Ranks ranks{std::vector<std::size_t>(values.size()), 0.0};
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    // Places begin + 1 to end share their mean.
    for (std::size_t i = begin; i < end; ++i) ranks.doubled[order[i]] = begin + 1 + end;
    const auto t = static_cast<double>(end - begin);
    ranks.tie_term += t * t * t - t;
  }
  return ranks;
}

std::optional<double> spearman(const std::vector<double>& x, const std::vector<double>& y) {
  const Ranks a = ranks_of(x);
  const Ranks b = ranks_of(y);
  // Pearson's correlation of the ranks, whose mean is known.
  const double mean = static_cast<double>(x.size()) + 1.0;
  double aa = 0.0;
  double ab = 0.0;
  double bb = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double da = static_cast<double>(a.doubled[i]) - mean;
    const double db = static_cast<double>(b.doubled[i]) - mean;
    aa += da * da;
    ab += da * db;
    bb += db * db;
  }
  if (aa == 0.0 || bb == 0.0) return std::nullopt;
  return ab / std::sqrt(aa * bb);
}

}  // namespace glocal
