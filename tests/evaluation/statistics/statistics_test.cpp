#include "evaluation/statistics/statistics.hpp"

#include <gtest/gtest.h>

namespace glocal::statistics_test {
namespace {

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  // R: quantile(c(1, 2, 4, 8), c(0, .25, .5, .75, .9, 1), type = 7)
  const std::vector<double> values = {8, 1, 4, 2};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 3.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.75), 5.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.9), 6.8);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 8.0);
}

TEST(Quantile, OfOneValueIsThatValueAndOfNoneZero) {
  for (const double p : {0.0, 0.3, 1.0}) {
    EXPECT_EQ(quantile({7.5}, p), 7.5);
    EXPECT_EQ(quantile({}, p), 0.0);
  }
}

TEST(MedianIfAny, IsTheMiddleOneOrNone) {
  EXPECT_EQ(median_if_any({8, 1, 4}), 4.0);
  EXPECT_EQ(median_if_any({8, 1, 4, 2}), 3.0);
  EXPECT_EQ(median_if_any({}), std::nullopt);
}

TEST(Mean, IsTheSumSharedOut) {
  EXPECT_DOUBLE_EQ(mean({1.0, 2.5, 4.0}), 2.5);
  EXPECT_EQ(mean({}), 0.0);
}

void expect_interval(std::size_t successes, std::size_t trials, double low, double high) {
  const Proportion p = wilson(successes, trials);
  EXPECT_DOUBLE_EQ(p.value, static_cast<double>(successes) / static_cast<double>(trials));
  EXPECT_NEAR(p.low, low, 5e-5) << successes << " of " << trials;
  EXPECT_NEAR(p.high, high, 5e-5) << successes << " of " << trials;
}

TEST(Wilson, AgreesWithPublishedIntervals) {
  // Newcombe (1998), table I, method 3: the score method without continuity correction.
  expect_interval(81, 263, 0.2553, 0.3662);
  expect_interval(15, 148, 0.0624, 0.1605);
  expect_interval(0, 20, 0.0, 0.1611);
  expect_interval(1, 29, 0.0061, 0.1718);
}

TEST(Wilson, AgreesWithItsClosedFormAtTheEnds) {
  // Of none (all) of n the bound is z^2 / (n + z^2) (n / (n + z^2)); z^2 = 3.841459.
  expect_interval(0, 10, 0.0, 3.841459 / 13.841459);
  expect_interval(10, 10, 10.0 / 13.841459, 1.0);
}

TEST(Wilson, IsWhereTheScoreTestJustRejects) {
  // (share - p)^2 = z^2 p (1 - p) / n at both bounds.
  for (const auto& [successes, trials] : {std::pair{42, 44}, {5, 20}, {1, 3}}) {
    const Proportion p = wilson(static_cast<std::size_t>(successes), static_cast<std::size_t>(trials));
    for (const double bound : {p.low, p.high}) {
      const double difference = p.value - bound;
      EXPECT_NEAR(difference * difference, 3.841458820694124 * bound * (1.0 - bound) / trials, 1e-12);
    }
    EXPECT_LT(p.low, p.value);
    EXPECT_GT(p.high, p.value);
  }
}

void expect_same(const Proportion& a, const Proportion& b) {
  EXPECT_NEAR(a.value, b.value, 1e-12);
  EXPECT_NEAR(a.low, b.low, 1e-12);
  EXPECT_NEAR(a.high, b.high, 1e-12);
}

TEST(WilsonOfClusters, SingleTrialsAreIndependent) {
  expect_same(wilson_of_clusters({{1, 1}, {0, 1}, {1, 1}, {1, 1}, {0, 0}}), wilson(3, 4));
}

TEST(WilsonOfClusters, CopiesTellNothingNew) {
  expect_same(wilson_of_clusters({{5, 5}, {0, 5}, {5, 5}, {5, 5}}), wilson(3, 4));
  expect_same(wilson_of_clusters({{3, 3}, {3, 3}}), wilson(2, 2));
}

TEST(WilsonOfClusters, EvenClustersTellNoMoreThanAllTheirTrials) {
  // Each has just the mean: less spread than that of independent trials.
  expect_same(wilson_of_clusters({{1, 2}, {1, 2}, {1, 2}}), wilson(3, 6));
}

TEST(WilsonOfClusters, SaysNothingWithoutTrials) {
  expect_same(wilson_of_clusters({}), Proportion{});
  expect_same(wilson_of_clusters({{0, 0}}), Proportion{});
}

TEST(Wilson, SaysNothingWithoutTrials) {
  const Proportion p = wilson(0, 0);
  EXPECT_EQ(p.value, 0.0);
  EXPECT_EQ(p.low, 0.0);
  EXPECT_EQ(p.high, 1.0);
}

}  // namespace
}  // namespace glocal::statistics_test
