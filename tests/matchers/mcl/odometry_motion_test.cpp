#include "matchers/mcl/odometry_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glocal::mcl::odometry_motion_test {
namespace {

struct Moments {
  double mean = 0.0, variance = 0.0;
};

Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double value : values) m.mean += value / static_cast<double>(values.size());
  for (const double value : values)
    m.variance += (value - m.mean) * (value - m.mean) / static_cast<double>(values.size());
  return m;
}

/// First rotation, way and second rotation of a robot that stood at the origin, from where it is now.
struct Parts {
  std::vector<double> first, way, second;
};

Parts parts_of_samples(const Pose2& increment, const OdometryNoise& noise, double direction) {
  const OdometryMotion motion(increment, noise);
  Rng rng(4);
  Parts parts;
  for (int i = 0; i < 200000; ++i) {
    const Pose2 pose = motion.sample({}, rng);
    // Around the direction without noise, so that angles do not wrap.
    const double first = direction + wrap_angle(std::atan2(pose.y, pose.x) - direction);
    parts.first.push_back(first);
    parts.way.push_back(std::hypot(pose.x, pose.y));
    parts.second.push_back(wrap_angle(pose.theta - first));
  }
  return parts;
}

void expect_near(const std::vector<double>& values, double mean, double variance) {
  const Moments m = moments(values);
  EXPECT_NEAR(m.mean, mean, 4.0 * std::sqrt(variance / 200000.0) + 1e-12);
  EXPECT_NEAR(m.variance, variance, 0.02 * variance + 1e-12);
}

TEST(OdometryMotion, EachPartHasTheMeanAndVarianceOfTable5_6) {
  const OdometryNoise noise{.alpha1 = 0.03, .alpha2 = 0.001, .alpha3 = 0.002, .alpha4 = 0.01};
  // 0.4 rad to the left, 2 m, then 0.3 rad to the right.
  const Pose2 increment{2.0 * std::cos(0.4), 2.0 * std::sin(0.4), 0.1};
  const Parts parts = parts_of_samples(increment, noise, 0.4);
  expect_near(parts.first, 0.4, 0.03 * 0.16 + 0.001 * 4.0);
  expect_near(parts.way, 2.0, 0.002 * 4.0 + 0.01 * (0.16 + 0.09));
  expect_near(parts.second, -0.3, 0.03 * 0.09 + 0.001 * 4.0);
}

TEST(OdometryMotion, BackingUpIsAsExactAsDrivingForward) {
  const OdometryNoise noise{.alpha1 = 0.2, .alpha2 = 0.0005, .alpha3 = 0.001, .alpha4 = 0.1};
  const Parts parts = parts_of_samples({-1.0, 0.0, 0.0}, noise, 3.141592653589793);
  expect_near(parts.first, 3.141592653589793, 0.0005);
  expect_near(parts.way, 1.0, 0.001);
}

TEST(OdometryMotion, TurningOnTheSpotIsOneRotation) {
  const OdometryMotion motion({0.0, 0.0, 0.5}, {.alpha1 = 0.04, .alpha2 = 9.0, .alpha3 = 9.0, .alpha4 = 0.0});
  Rng rng(1);
  std::vector<double> turns;
  for (int i = 0; i < 200000; ++i) {
    const Pose2 pose = motion.sample({1.0, 2.0, 0.0}, rng);
    EXPECT_EQ(pose.x, 1.0);
    EXPECT_EQ(pose.y, 2.0);
    turns.push_back(pose.theta);
  }
  expect_near(turns, 0.5, 0.04 * 0.25);
}

TEST(OdometryMotion, WithoutNoiseItIsTheIncrement) {
  const Pose2 increment{0.3, -0.2, 1.0};
  const OdometryMotion motion(increment, {.alpha1 = 0.0, .alpha2 = 0.0, .alpha3 = 0.0, .alpha4 = 0.0});
  Rng rng(1);
  const Pose2 start{2.0, 3.0, 2.5};
  const Pose2 expected = start * increment;
  const Pose2 pose = motion.sample(start, rng);
  EXPECT_NEAR(pose.x, expected.x, 1e-12);
  EXPECT_NEAR(pose.y, expected.y, 1e-12);
  EXPECT_NEAR(pose.theta, expected.theta, 1e-12);
}

}  // namespace
}  // namespace glocal::mcl::odometry_motion_test
