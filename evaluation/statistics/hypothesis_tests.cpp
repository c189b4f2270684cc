#include "evaluation/statistics/hypothesis_tests.hpp"

#include <algorithm>
#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <iterator>
#include <numeric>

#include "evaluation/statistics/ranks.hpp"

namespace glocal {
namespace {

/// How likely each sum of sizes is, if each is in it or not with equal chance; size by size, smallest first.
std::vector<double> chances_of_sums(std::vector<std::size_t> sizes) {
  std::sort(sizes.begin(), sizes.end());
  std::vector<double> chances(std::accumulate(sizes.begin(), sizes.end(), std::size_t{1}), 0.0);
  chances[0] = 1.0;
  std::size_t largest = 0;
  for (const std::size_t size : sizes) {
    largest += size;
    for (std::size_t sum = largest; sum >= size; --sum)
      chances[sum] = (chances[sum] + chances[sum - size]) / 2.0;
    for (std::size_t sum = 0; sum < size; ++sum) chances[sum] /= 2.0;
  }
  return chances;
}

/// How likely a sum is that is this small, or as large on the other side: the distribution is symmetric.
double two_sided(const std::vector<double>& chances, std::size_t small_sum) {
  const auto end = chances.begin() + static_cast<std::ptrdiff_t>(small_sum) + 1;
  return std::min(1.0, 2.0 * std::accumulate(chances.begin(), end, 0.0));
}

double exact_p(const std::vector<std::size_t>& ranks, std::size_t positive_sum) {
  const std::vector<double> chances = chances_of_sums(ranks);
  return two_sided(chances, std::min(positive_sum, chances.size() - 1 - positive_sum));
}

double approximate_p(const SignedRank& test, double tie_term) {
  const auto n = static_cast<double>(test.nonzero);
  const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - tie_term / 48.0;
  const double beyond = std::max(0.0, std::abs(test.positive_sum - test.expected_sum) - 0.5);
  const boost::math::normal standard;
  return 2.0 * boost::math::cdf(boost::math::complement(standard, beyond / std::sqrt(variance)));
}

}  // namespace

SignFlips sign_flip_test(const std::vector<long>& differences) {
  SignFlips test;
  std::vector<std::size_t> sizes;
  for (const long difference : differences) {
    if (difference == 0) continue;
    sizes.push_back(static_cast<std::size_t>(std::abs(difference)));
    test.sum += difference;
  }
  test.differing = sizes.size();
  if (test.sum == 0) return test;
  // The sum is twice that of the positive sizes, less the total.
  const auto total = static_cast<long>(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
  test.p = two_sided(chances_of_sums(sizes), static_cast<std::size_t>((total - std::abs(test.sum)) / 2));
  return test;
}

SignedRank wilcoxon_signed_rank(const std::vector<double>& differences) {
  std::vector<double> sizes;
  std::vector<bool> is_positive;
  for (const double difference : differences) {
    if (difference == 0.0) continue;
    sizes.push_back(std::abs(difference));
    is_positive.push_back(difference > 0.0);
  }
  SignedRank test;
  test.nonzero = sizes.size();
  if (sizes.empty()) return test;
  const Ranks ranks = ranks_of(sizes);
  std::size_t doubled_sum = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) doubled_sum += is_positive[i] ? ranks.doubled[i] : 0;
  const auto n = static_cast<double>(test.nonzero);
  test.positive_sum = static_cast<double>(doubled_sum) / 2.0;
  test.expected_sum = n * (n + 1.0) / 4.0;
  test.exact = test.nonzero <= most_exact_differences;
  test.p = test.exact ? exact_p(ranks.doubled, doubled_sum) : approximate_p(test, ranks.tie_term);
  return test;
}

double fisher_exact(const TrialCluster& first, const TrialCluster& second) {
  const std::size_t trials = first.trials + second.trials;
  const std::size_t successes = first.successes + second.successes;
  const std::size_t failures = trials - successes;
  if (trials == 0) return 1.0;
  const boost::math::hypergeometric_distribution<> chances(
      static_cast<unsigned>(successes), static_cast<unsigned>(first.trials), static_cast<unsigned>(trials));
  constexpr double rounding = 1.0 + 1e-7;  // of divisions that are equally likely
  const double seen = boost::math::pdf(chances, first.successes) * rounding;
  double p = 0.0;
  for (std::size_t n = first.trials - std::min(first.trials, failures);
       n <= std::min(first.trials, successes); ++n) {
    const double chance = boost::math::pdf(chances, n);
    if (chance <= seen) p += chance;
  }
  return std::min(1.0, p);
}

double least_p(std::size_t differing) {
  return std::min(1.0, 2.0 * std::exp2(-static_cast<double>(differing)));
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0.0;  // A test is not more significant than one with a smaller p.
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(order.size() - i) * p[order[i]]);
    adjusted[order[i]] = std::min(1.0, largest);
  }
  return adjusted;
}

}  // namespace glocal
