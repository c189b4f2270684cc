#include "raters/exponential_threshold.hpp"

#include <gtest/gtest.h>

#include "raters/with_scores.hpp"

namespace glocal::raters::exponential_threshold_test {
namespace {

using test::with_scores;

TEST(ExponentialThreshold, ByHand) {
  ExponentialThreshold threshold({.weight = 0.25, .initial = 0.6});
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.6);
  threshold.update(with_scores({0.9, 0.7}));  // 0.75 * 0.6 + 0.25 * 0.8
  EXPECT_NEAR(threshold.omega_max(), 0.65, 1e-12);
  threshold.update(with_scores({1.0}));  // 0.75 * 0.65 + 0.25
  EXPECT_NEAR(threshold.omega_max(), 0.7375, 1e-12);
}

TEST(ExponentialThreshold, SupportCounts) {
  ExponentialThreshold threshold({.weight = 1.0});
  std::vector<Hypothesis> hypotheses = with_scores({0.9, 0.5});
  hypotheses[1].support = 3;
  threshold.update(hypotheses);
  EXPECT_NEAR(threshold.omega_max(), 0.6, 1e-12);  // (0.9 + 3 * 0.5) / 4
}

TEST(ExponentialThreshold, EmptyStepsLetItFall) {
  ExponentialThreshold threshold({.weight = 0.1, .initial = 0.8});
  threshold.update({});
  EXPECT_NEAR(threshold.omega_max(), 0.72, 1e-12);
  for (int i = 0; i < 200; ++i) threshold.update({});
  EXPECT_LT(threshold.omega_max(), 1e-6);
  EXPECT_GE(threshold.omega_max(), 0.0);
  threshold.reset();
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.8);
}

TEST(ExponentialThreshold, ScoresThatStayTheSameReachIt) {
  test::expect_reached_by_equal_scores(ExponentialThreshold({.weight = 0.7}));
}

}  // namespace
}  // namespace glocal::raters::exponential_threshold_test
