#include "evaluation/statistics/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace glocal {
namespace {

double student_t(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

Proportion wilson_interval(double share, double n) {
  const double z = boost::math::quantile(boost::math::normal(), 0.975);
  const double scale = 1.0 / (1.0 + z * z / n);
  const double centre = scale * (share + z * z / (2.0 * n));
  const double half = scale * z * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n));
  return {share, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

}  // namespace

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double place = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - std::floor(place));
}

std::optional<double> median_if_any(std::vector<double> values) {
  return values.empty() ? std::nullopt : std::optional(quantile(std::move(values), 0.5));
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Proportion wilson(std::size_t successes, std::size_t trials) {
  if (trials == 0) return {};
  const auto n = static_cast<double>(trials);
  return wilson_interval(static_cast<double>(successes) / n, n);
}

Proportion wilson_of_clusters(const std::vector<TrialCluster>& clusters) {
  double successes = 0.0, trials = 0.0, filled = 0.0, squared_trials = 0.0;
  for (const TrialCluster& cluster : clusters) {
    const auto n = static_cast<double>(cluster.trials);
    successes += static_cast<double>(cluster.successes);
    trials += n;
    filled += n > 0.0 ? 1.0 : 0.0;
    squared_trials += n * n;
  }
  if (trials == 0.0) return {};
  const double share = successes / trials;
  if (share == 0.0 || share == 1.0 || filled == 1.0) return wilson_interval(share, filled);
  double squares = 0.0;
  for (const TrialCluster& cluster : clusters) {
    const double excess =
        static_cast<double>(cluster.successes) - share * static_cast<double>(cluster.trials);
    squares += excess * excess;
  }
  // The variance of the share if trials were independent, and as clusters tell it.
  const double independent = share * (1.0 - share) / (trials - 1.0);
  const double clustered = filled / (filled - 1.0) * squares / (trials * trials);
  const double t_ratio = student_t(trials - 1.0) / student_t(filled - 1.0);
  // As if all trials of each cluster ended alike (Kish 1965).
  const double fewest = trials * trials / squared_trials;
  const double effective = trials * independent / clustered * t_ratio * t_ratio;
  return wilson_interval(share, std::clamp(effective, fewest, trials));
}

}  // namespace glocal
