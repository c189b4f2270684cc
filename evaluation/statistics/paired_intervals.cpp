#include "evaluation/statistics/paired_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "evaluation/statistics/statistics.hpp"

namespace glocal {
namespace {

/// Correlation of the two properties; 0 where one of them has no spread.
double phi(const PairedCounts& counts) {
  const auto a = static_cast<double>(counts.both);
  const auto b = static_cast<double>(counts.only_first);
  const auto c = static_cast<double>(counts.only_second);
  const auto d = static_cast<double>(counts.neither);
  const double margins = (a + b) * (c + d) * (a + c) * (b + d);
  if (margins == 0.0) return 0.0;
  const double product = a * d - b * c;
  const double corrected = product > 0.0 ? std::max(0.0, product - (a + b + c + d) / 2.0) : product;
  return corrected / std::sqrt(margins);
}

/// Length of the third side of a triangle.
double join(double x, double y, double correlation) {
  return std::sqrt(std::max(0.0, x * x - 2.0 * correlation * x * y + y * y));
}

}  // namespace

Interval newcombe_paired(const PairedCounts& counts) {
  const std::size_t n = counts.both + counts.only_first + counts.only_second + counts.neither;
  if (n == 0) return {-1.0, 1.0};
  const Proportion first = wilson(counts.both + counts.only_first, n);
  const Proportion second = wilson(counts.both + counts.only_second, n);
  const double correlation = phi(counts);
  const double difference = second.value - first.value;
  return {difference - join(second.value - second.low, first.high - first.value, correlation),
          difference + join(second.high - second.value, first.value - first.low, correlation)};
}

Interval bootstrap(const std::vector<double>& values, const Statistic& statistic, Rng rng) {
  const auto n = static_cast<std::uint32_t>(values.size());
  std::vector<double> resample(values.size());
  std::vector<double> statistics(bootstrap_resamples);
  for (double& result : statistics) {
    for (double& value : resample) value = values[rng.below(n)];
    result = statistic(resample);
  }
  return {quantile(statistics, 0.025), quantile(statistics, 0.975)};
}

}  // namespace glocal
