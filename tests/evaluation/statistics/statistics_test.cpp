#include "evaluation/statistics/statistics.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "glocal/rng.hpp"

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

TEST(WilsonOfClusters, OneClusterIsOneTrial) {
  const Proportion p = wilson_of_clusters({{6, 8}, {0, 0}});
  EXPECT_EQ(p.value, 0.75);
  EXPECT_NEAR(p.low, 0.11790958799950951, 1e-9);
  EXPECT_NEAR(p.high, 0.9853650691891092, 1e-9);
}

// From the published formulas, computed with SciPy 1.10.
TEST(WilsonOfClusters, FewClustersTellTheirVarianceBadly) {
  // As 35.12 trials of 64: the variance is 0.718 of independent ones', (t_63 / t_3)^2 is 0.394.
  const Proportion some = wilson_of_clusters({{10, 16}, {8, 16}, {6, 16}, {9, 16}});
  EXPECT_NEAR(some.low, 0.35715832580239026, 1e-9);
  EXPECT_NEAR(some.high, 0.6710107326729265, 1e-9);
  // As 2.68 trials, but three clusters tell no less than three trials.
  const Proportion least = wilson_of_clusters({{12, 16}, {8, 16}, {4, 16}});
  EXPECT_NEAR(least.low, 0.12533447191026326, 1e-9);
  EXPECT_NEAR(least.high, 0.8746655280897367, 1e-9);
}

TEST(WilsonOfClusters, HoldsTheShareOfAllPlacesAlsoWithFewOfThem) {
  // Places at which 40 to 100 % of the trials are right, 70 % of all: without Student's t and with the
  // variance of these few places as if it were that of all, 79 to 91 % of the intervals hold it.
  Rng rng(5);
  for (const std::size_t places : {3U, 5U, 10U}) {
    int held = 0;
    for (int i = 0; i < 2000; ++i) {
      std::vector<TrialCluster> clusters(places, {0, 20});
      for (TrialCluster& place : clusters) {
        const double share = rng.uniform(0.4, 1.0);
        for (std::size_t t = 0; t < place.trials; ++t)
          place.successes += rng.uniform(0.0, 1.0) < share ? 1 : 0;
      }
      const Proportion p = wilson_of_clusters(clusters);
      held += p.low <= 0.7 && 0.7 <= p.high ? 1 : 0;
    }
    EXPECT_GT(held, 0.925 * 2000) << places;
    EXPECT_LT(held, 0.98 * 2000) << places;
  }
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
