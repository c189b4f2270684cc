#include "raters/sliding_window.hpp"

#include <gtest/gtest.h>

#include "raters/with_scores.hpp"

namespace glocal::raters::sliding_window_test {
namespace {

using test::with_scores;

TEST(SlidingWindow, StartsAtTheInitialThreshold) {
  EXPECT_DOUBLE_EQ(SlidingWindow({.window = 10, .initial = 0.6}).omega_max(), 0.6);
}

TEST(SlidingWindow, Equation9ByHand) {
  SlidingWindow threshold({.window = 4, .initial = 0.5});
  threshold.update(with_scores({0.6, 0.8}));  // step mean 0.7
  EXPECT_NEAR(threshold.omega_max(), (3 * 0.5 + 0.7) / 4, 1e-12);
  threshold.update(with_scores({0.9}));
  threshold.update(with_scores({0.8}));
  threshold.update(with_scores({0.6}));
  EXPECT_NEAR(threshold.omega_max(), (0.7 + 0.9 + 0.8 + 0.6) / 4, 1e-12);
  threshold.update(with_scores({1.0}));  // 0.7 leaves the window
  EXPECT_NEAR(threshold.omega_max(), (0.9 + 0.8 + 0.6 + 1.0) / 4, 1e-12);
}

TEST(SlidingWindow, AnEmptyStepLowersItByAWindowth) {
  SlidingWindow threshold({.window = 10, .initial = 0.8});
  threshold.update({});
  EXPECT_NEAR(threshold.omega_max(), 0.72, 1e-12);
  for (int i = 0; i < 9; ++i) threshold.update({});
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.0);
}

TEST(SlidingWindow, ResetForgets) {
  SlidingWindow threshold({.window = 3, .initial = 0.6});
  threshold.update({});
  threshold.reset();
  EXPECT_DOUBLE_EQ(threshold.omega_max(), 0.6);
}

TEST(SlidingWindow, ScoresThatStayTheSameReachIt) {
  test::expect_reached_by_equal_scores(SlidingWindow({.window = 10}));
}

}  // namespace
}  // namespace glocal::raters::sliding_window_test
