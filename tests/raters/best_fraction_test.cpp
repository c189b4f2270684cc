#include "raters/best_fraction.hpp"

#include <gtest/gtest.h>

#include "raters/with_scores.hpp"

namespace glocal::raters::best_fraction_test {
namespace {

using test::with_scores;

TEST(BestFraction, OfTheLastStep) {
  BestFraction threshold({.fraction = 0.5, .best = "last_step", .initial = 0.45});
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.45);
  threshold.update(with_scores({0.8, 0.6}));
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.4);
  threshold.update(with_scores({0.6}));
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.3);
}

TEST(BestFraction, OfTheBestSoFar) {
  BestFraction threshold({.fraction = 0.5, .best = "so_far", .initial = 0.45});
  threshold.update(with_scores({0.8, 0.6}));
  threshold.update(with_scores({0.6}));
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.4);
  threshold.update({});  // 0.8 counts as 0.72 now
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.36);
  threshold.update(with_scores({0.7}));
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.36);
  threshold.update(with_scores({0.75}));
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.375);
  threshold.reset();
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.45);
  threshold.update(with_scores({0.1}));
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.05);
}

TEST(BestFraction, EmptyStepsLetItFallFromTheStart) {
  BestFraction threshold({.initial = 0.5});
  threshold.update({});
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.45);
}

}  // namespace
}  // namespace glocal::raters::best_fraction_test
