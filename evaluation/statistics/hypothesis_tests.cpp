#include "evaluation/statistics/hypothesis_tests.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <iterator>
#include <numeric>

#include "evaluation/statistics/ranks.hpp"

namespace glocal {
namespace {

/// In how many of the 2^n ways to give signs the positive ranks have each sum, by counting, rank by rank. All
/// are whole numbers up to 2^50, which a double holds exactly.
std::vector<double> ways_to_sums(const std::vector<std::size_t>& ranks) {
  const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  std::vector<double> ways(total + 1, 0.0);
  ways[0] = 1.0;
  for (const std::size_t rank : ranks) {
    for (std::size_t sum = total; sum >= rank; --sum) ways[sum] += ways[sum - rank];
  }
  return ways;
}

double exact_p(const std::vector<std::size_t>& ranks, std::size_t positive_sum) {
  const std::vector<double> ways = ways_to_sums(ranks);
  const std::size_t total = ways.size() - 1;
  // The distribution is symmetric: the upper tail of a sum is the lower tail of what is left of the total.
  const std::size_t tail = std::min(positive_sum, total - positive_sum);
  const double at_most =
      std::accumulate(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(tail) + 1, 0.0);
  return std::min(1.0, 2.0 * at_most / std::exp2(static_cast<double>(ranks.size())));
}

double approximate_p(const SignedRank& test, double tie_term) {
  const auto n = static_cast<double>(test.nonzero);
  const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - tie_term / 48.0;
  const double beyond = std::max(0.0, std::abs(test.positive_sum - test.expected_sum) - 0.5);
  const boost::math::normal standard;
  return 2.0 * boost::math::cdf(boost::math::complement(standard, beyond / std::sqrt(variance)));
}

/// The number of the mean, from the smallest on and counted from 1, at which the 95 % interval begins: at
/// least the first.
std::size_t rank_of_low(std::size_t n) {
  constexpr double tail = 0.025;
  if (n <= most_exact_differences) {
    std::vector<std::size_t> ranks(n);
    std::iota(ranks.begin(), ranks.end(), std::size_t{1});
    const std::vector<double> ways = ways_to_sums(ranks);
    const double wanted = tail * std::exp2(static_cast<double>(n));
    double below = 0.0;
    std::size_t sum = 0;
    while ((below += ways[sum]) < wanted) ++sum;
    return std::max<std::size_t>(sum, 1);
  }
  const auto x = static_cast<double>(n);
  const boost::math::normal standard;
  const double z = boost::math::quantile(boost::math::complement(standard, tail));
  return static_cast<std::size_t>(x * (x + 1.0) / 4.0 -
                                  z * std::sqrt(x * (x + 1.0) * (2.0 * x + 1.0) / 24.0));
}

/// How many means of two values, each with itself, too, are at most `limit`; the values ascend.
std::size_t count_means(const std::vector<double>& values, double limit) {
  std::size_t count = 0;
  std::size_t end = values.size();
  for (std::size_t i = 0; i < end; ++i) {
    while (end > i && (values[i] + values[end - 1]) / 2.0 > limit) --end;
    count += end - i;
  }
  return count;
}

/// The k-th smallest of these means, from 1, found by halving: of a hundred thousand values there are
/// billions.
double mean_at(const std::vector<double>& values, std::size_t k) {
  double low = values.front(), high = values.back();
  if (count_means(values, low) >= k) return low;
  // The answer is above low, and at most high, until nothing lies between the two.
  for (;;) {
    const double middle = low + (high - low) / 2.0;
    if (!(middle > low && middle < high)) return high;
    (count_means(values, middle) >= k ? high : low) = middle;
  }
}

}  // namespace

double mcnemar_exact(std::size_t only_first, std::size_t only_second) {
  const auto n = static_cast<double>(only_first + only_second);
  if (n == 0.0) return 1.0;
  const boost::math::binomial fair(n, 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(fair, static_cast<double>(std::min(only_first, only_second))));
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

ShiftEstimate hodges_lehmann(const std::vector<double>& differences) {
  std::vector<double> values;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(values),
               [](double difference) { return difference != 0.0; });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t means = values.size() * (values.size() + 1) / 2;
  const std::size_t low = rank_of_low(values.size());
  const double below = mean_at(values, (means + 1) / 2);
  const double above = means % 2 == 1 ? below : mean_at(values, means / 2 + 1);
  return {(below + above) / 2.0, mean_at(values, low), mean_at(values, means + 1 - low)};
}

double least_p(std::size_t differing_pairs) {
  return std::min(1.0, 2.0 * std::exp2(-static_cast<double>(differing_pairs)));
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
