#include "glocal/pose2.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace glocal::pose2_test {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Pose2, WrapsAnglesToHalfOpenInterval) {
  EXPECT_DOUBLE_EQ(wrap_angle(pi), pi);
  EXPECT_DOUBLE_EQ(wrap_angle(-pi), pi);
  EXPECT_NEAR(wrap_angle(3.0 * pi), pi, 1e-12);
  EXPECT_NEAR(wrap_angle(2.0 * pi + 0.25), 0.25, 1e-12);
  EXPECT_NEAR(wrap_angle(-2.0 * pi - 0.25), -0.25, 1e-12);
}

TEST(Pose2, ComposesAsByHand) {
  // A quarter turn to the left at (1, 2), then 3 m forward and 1 m to the left.
  const Pose2 c = Pose2{1.0, 2.0, pi / 2} * Pose2{3.0, 1.0, pi / 2};
  EXPECT_NEAR(c.x, 0.0, 1e-12);
  EXPECT_NEAR(c.y, 5.0, 1e-12);
  EXPECT_NEAR(c.theta, pi, 1e-12);
}

TEST(Pose2, InverseUndoes) {
  const Pose2 p{-4.0, 0.5, 2.5};
  for (const Pose2& unit : {p * inverse(p), inverse(p) * p}) {
    EXPECT_NEAR(unit.x, 0.0, 1e-12);
    EXPECT_NEAR(unit.y, 0.0, 1e-12);
    EXPECT_NEAR(unit.theta, 0.0, 1e-12);
  }
}

TEST(Pose2, RotationBetweenTakesTheShortWay) {
  EXPECT_NEAR(rotation_between({0, 0, pi - 0.1}, {0, 0, -pi + 0.2}), 0.3, 1e-12);
}

}  // namespace
}  // namespace glocal::pose2_test
