#include "raters/quantile_threshold.hpp"

#include <gtest/gtest.h>

#include "raters/with_scores.hpp"

namespace glocal::raters::quantile_threshold_test {
namespace {

using test::with_scores;

double after(double quantile, const std::vector<Hypothesis>& hypotheses) {
  QuantileThreshold threshold({.quantile = quantile});
  threshold.update(hypotheses);
  return threshold.omega_max();
}

TEST(QuantileThreshold, ByHand) {
  const std::vector<Hypothesis> hypotheses = with_scores({0.9, 0.8, 0.7, 0.6});
  EXPECT_DOUBLE_EQ(after(0.0, hypotheses), 0.6);
  EXPECT_DOUBLE_EQ(after(0.25, hypotheses), 0.6);  // a quarter of them is not above 0.6
  EXPECT_DOUBLE_EQ(after(0.26, hypotheses), 0.7);
  EXPECT_DOUBLE_EQ(after(0.5, hypotheses), 0.7);
  EXPECT_DOUBLE_EQ(after(0.75, hypotheses), 0.8);
  EXPECT_DOUBLE_EQ(after(1.0, hypotheses), 0.9);
  EXPECT_DOUBLE_EQ(after(0.5, with_scores({0.3})), 0.3);
}

TEST(QuantileThreshold, SupportCounts) {
  std::vector<Hypothesis> hypotheses = with_scores({0.9, 0.8, 0.7});
  hypotheses[0].support = 8;
  EXPECT_DOUBLE_EQ(after(0.2, hypotheses), 0.8);  // of ten, two are at most 0.8
  EXPECT_DOUBLE_EQ(after(0.21, hypotheses), 0.9);
}

TEST(QuantileThreshold, OnlyTheLastStepCountsAndEmptyOnesLetItFall) {
  QuantileThreshold threshold({.quantile = 0.5, .initial = 0.4});
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.4);
  threshold.update(with_scores({0.9, 0.8}));
  threshold.update(with_scores({0.6}));
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.6);
  threshold.update({});
  threshold.update({});
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.486);
  threshold.reset();
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.4);
}

}  // namespace
}  // namespace glocal::raters::quantile_threshold_test
