#include "matchers/mcl/resampling.hpp"

#include <algorithm>
#include <cmath>

namespace glocal::mcl {

std::vector<std::uint32_t> low_variance_draws(const std::vector<double>& weights, std::size_t n,
                                              double offset) {
  std::vector<std::uint32_t> draws;
  draws.reserve(n);
  double below = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    below += weights[i] * static_cast<double>(n);
    while (draws.size() < n && static_cast<double>(draws.size()) + offset < below) {
      draws.push_back(static_cast<std::uint32_t>(i));
    }
  }
  // Rounding may leave the sum a little below 1.
  const auto heaviest = std::ranges::max_element(weights) - weights.begin();
  const auto last = draws.empty() ? static_cast<std::uint32_t>(heaviest) : draws.back();
  draws.resize(n, last);
  return draws;
}

double kld_sample_size(std::size_t bins, double error, double quantile) {
  if (bins <= 1) return 1.0;
  const auto freedom = static_cast<double>(bins - 1);
  const double spread = 2.0 / (9.0 * freedom);
  const double root = 1.0 - spread + std::sqrt(spread) * quantile;
  return freedom / (2.0 * error) * root * root * root;
}

void RecoveryAverages::add(double likelihood) {
  if (slow_ == 0.0) {
    slow_ = fast_ = likelihood;
  } else {
    slow_ += slow_rate_ * (likelihood - slow_);
    fast_ += fast_rate_ * (likelihood - fast_);
  }
}

double RecoveryAverages::share_of_new() const {
  if (slow_rate_ == 0.0 || fast_rate_ == 0.0 || slow_ == 0.0) return 0.0;
  return std::max(0.0, 1.0 - fast_ / slow_);
}

}  // namespace glocal::mcl
