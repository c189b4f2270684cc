#include "local_mappers/moving_along.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "local_mappers/drives.hpp"

namespace glocal::local_mappers::moving_along_test {
namespace {

using test::circle;
using test::Drive;
using test::drive;

constexpr float arm = 0.6F;  // m

/// Somebody who stands this far to both sides of straight ahead, an arm's length before the sensor.
Scan with_companion(Scan scan, double half_angle_deg) {
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    const double angle = std::atan2(scan.hits.y[i], scan.hits.x[i]);
    if (std::abs(angle) <= radians(half_angle_deg))
      scan.hits.set(
          i, {arm * std::cos(static_cast<float>(angle)), arm * std::sin(static_cast<float>(angle)), 0});
  }
  return scan;
}

std::size_t number_of_companion(const Scan& scan) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < scan.hits.size(); ++i)
    n += std::abs(std::hypot(scan.hits.x[i], scan.hits.y[i]) - arm) < 1e-3F ? 1U : 0U;
  return n;
}

/// Whether exactly the companion's hits are found.
void expect_companion(const Scan& scan, const std::vector<bool>& moving) {
  ASSERT_EQ(moving.size(), scan.hits.size());
  for (std::size_t i = 0; i < moving.size(); ++i)
    EXPECT_EQ(moving[i], std::abs(std::hypot(scan.hits.x[i], scan.hits.y[i]) - arm) < 1e-3F) << i;
}

void expect_none(const std::vector<bool>& moving) {
  EXPECT_EQ(std::count(moving.begin(), moving.end(), true), 0);
}

TEST(MovingAlong, FindsACompanionFromTheSecondObservationOn) {
  Drive exact = drive(test::furnished_room(), circle(20), {}, {});
  MovingAlong moving_along;
  for (std::size_t k = 0; k < exact.observations.size(); ++k) {
    Observation& observation = exact.observations[k];
    observation.scan = with_companion(observation.scan, 45.0);
    ASSERT_GE(number_of_companion(observation.scan), 170U);
    const std::vector<bool> moving = moving_along.update(observation);
    if (k == 0)
      expect_none(moving);
    else
      expect_companion(observation.scan, moving);
  }
}

TEST(MovingAlong, ACompanionIsKnownWhileTheRobotStands) {
  Drive exact = drive(test::furnished_room(), circle(2), {}, {});
  MovingAlong moving_along;
  for (Observation& observation : exact.observations) {
    observation.scan = with_companion(observation.scan, 30.0);
    static_cast<void>(moving_along.update(observation));
  }
  Observation standing = exact.observations.back();
  expect_companion(standing.scan, moving_along.update(standing));
  expect_companion(standing.scan, moving_along.update(standing));
  // When the companion has gone, what stands behind is of the place.
  standing.scan = drive(test::furnished_room(), circle(2), {}, {}).observations.back().scan;
  expect_none(moving_along.update(standing));
}

TEST(MovingAlong, WhatIsNearerThanAnArmWhileTheRobotStandsIsNotTakenForIt) {
  Observation standing = drive(test::furnished_room(), circle(2), {}, {}).observations.back();
  standing.scan.hits.set(0, {0.05F, 0.0F, 0.0F});
  MovingAlong moving_along;
  expect_none(moving_along.update(standing));
  expect_none(moving_along.update(standing));
}

TEST(MovingAlong, WhatStandsIsNotTakenForIt) {
  // The circle leads past a pillar, between 1 and 2 m away.
  const Drive noisy = drive(test::furnished_room(), circle(60), {.noise = 0.02}, test::bad_odometry);
  MovingAlong moving_along;
  for (const Observation& observation : noisy.observations) expect_none(moving_along.update(observation));
}

TEST(MovingAlong, WallsAlongsideAreNotTakenForIt) {
  std::vector<Pose2> poses;
  for (int i = 0; i < 20; ++i) poses.push_back({0.25 * i, 0.3, 0.0});
  const Drive corridor = drive(test::bare_corridor(), poses, {.max_range = 10.0, .noise = 0.01}, {});
  MovingAlong moving_along;
  for (const Observation& observation : corridor.observations) expect_none(moving_along.update(observation));
}

TEST(MovingAlong, WheelsThatSpinMakeNothingMove) {
  Drive exact = drive(test::furnished_room(), circle(1), {}, {});
  Observation observation = exact.observations.front();
  observation.scan = with_companion(observation.scan, 45.0);
  MovingAlong moving_along;
  for (int i = 0; i < 5; ++i) {
    observation.odom_from_robot.x += 0.3;
    expect_none(moving_along.update(observation));
  }
}

}  // namespace
}  // namespace glocal::local_mappers::moving_along_test
