#include "glocal/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glocal::pose_covariance_test {
namespace {

TEST(NormalisedError, IsTheSumOfSquaredDeviationsWhereNothingIsCorrelated) {
  const PoseCovariance c{.xx = 0.01, .yy = 0.04, .tt = 0.0025};
  // 0.1 / 0.1 + 0.4 / 0.2 + 0.15 / 0.05, each squared.
  EXPECT_NEAR(normalised_error_squared({1.1, 2.4, 0.15}, {1.0, 2.0, 0.0}, c), 1.0 + 4.0 + 9.0, 1e-9);
}

TEST(NormalisedError, TakesTheShortWayRound) {
  const PoseCovariance c{.xx = 1.0, .yy = 1.0, .tt = 0.01};
  EXPECT_NEAR(normalised_error_squared({0, 0, std::numbers::pi - 0.05}, {0, 0, -std::numbers::pi + 0.05}, c),
              1.0, 1e-9);
}

TEST(NormalisedError, CountsAnErrorAlongTheCorrelationLess) {
  // Inverse of [[2, 1], [1, 2]] is [[2, -1], [-1, 2]] / 3.
  const PoseCovariance c{.xx = 2.0, .xy = 1.0, .yy = 2.0, .tt = 1.0};
  EXPECT_NEAR(normalised_error_squared({1, 1, 0}, {}, c), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(normalised_error_squared({1, -1, 0}, {}, c), 2.0, 1e-12);
}

TEST(NormalisedError, IsInfiniteForWhatIsNoCovariance) {
  EXPECT_TRUE(std::isinf(normalised_error_squared({1, 0, 0}, {}, {.xx = 1.0, .yy = -1.0, .tt = 1.0})));
  EXPECT_TRUE(std::isinf(normalised_error_squared({1, 0, 0}, {}, {})));
}

}  // namespace
}  // namespace glocal::pose_covariance_test
