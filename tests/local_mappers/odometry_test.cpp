#include "local_mappers/odometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "local_mappers/drives.hpp"

namespace glocal::local_mappers::odometry_test {
namespace {

using test::at;
using ::testing::ElementsAre;

Observation seen_at(const Pose2& odom_from_robot, const Point& hit) {
  Observation observation;
  observation.odom_from_robot = odom_from_robot;
  observation.scan.hits.push_back(hit);
  return observation;
}

TEST(Odometry, PutsHitsWhereOdometrySays) {
  Odometry mapper({}, {});
  // Odometry begins at (2, 1) looking along y; then 1 m ahead; then a quarter turn to the left.
  mapper.add(seen_at({2, 1, radians(90)}, {1.01F, 0.01F, 0}));
  mapper.add(seen_at({2, 2, radians(90)}, {1.01F, 0.01F, 0}));
  mapper.add(seen_at({2, 2, radians(180)}, {1.01F, 0.01F, 0}));
  const LocalMap& map = mapper.map();
  ASSERT_THAT(map.ends, ElementsAre(1U, 2U, 3U));
  EXPECT_NEAR(map.points.x[0], 1.01F, 1e-5F);
  EXPECT_NEAR(map.points.x[1], 2.01F, 1e-5F);
  EXPECT_NEAR(map.points.x[2], 0.99F, 1e-5F);
  EXPECT_NEAR(map.points.y[2], 1.01F, 1e-5F);
  EXPECT_NEAR(map.local_from_robot.x, 1.0, 1e-12);
  EXPECT_NEAR(map.local_from_robot.heading(), radians(90), 1e-12);
}

TEST(Odometry, ThinsAsScanMatchingDoes) {
  Odometry mapper({}, {});
  // All of these fall into the cell from (1.00, 0.00) to (1.05, 0.05); the mean of the first three stays.
  for (const float y : {0.01F, 0.02F, 0.03F, 0.049F}) mapper.add(at(0.0, {{1.02F, y, 0}}));
  EXPECT_THAT(mapper.map().ends, ElementsAre(1U, 1U, 1U, 1U));
  EXPECT_NEAR(mapper.map().points.y[0], 0.02F, 1e-6F);
}

TEST(Odometry, IsNotCorrectedByScans) {
  const test::Drive drive = test::drive(test::furnished_room(), test::circle(60), {}, test::bad_odometry);
  Odometry mapper({}, {});
  for (const Observation& observation : drive.observations) mapper.add(observation);
  const Pose3 odom =
      inverse(drive.observations.front().odom_from_robot) * drive.observations.back().odom_from_robot;
  const Pose2 truth = inverse(drive.map_from_robot.front()) * drive.map_from_robot.back();
  EXPECT_NEAR(distance(mapper.map().local_from_robot, odom), 0.0, 1e-9);
  EXPECT_GT(distance(mapper.map().local_from_robot, truth), 0.2);
}

TEST(Odometry, StartsAnewWhenTheRobotLeavesTheGrid) {
  Odometry mapper({}, {});
  mapper.add(at(0.0, {{1.01F, 0.01F, 0}}));
  mapper.add(at(700.0, {{1.01F, 0.01F, 0}}));
  EXPECT_EQ(mapper.map().epoch, 0);
  mapper.add(at(900.0, {{1.01F, 0.01F, 0}}));
  EXPECT_EQ(mapper.map().epoch, 1);
  EXPECT_EQ(mapper.map().local_from_robot, Pose2{});
  EXPECT_THAT(mapper.map().ends, ElementsAre(1U));
  mapper.add(at(901.0, {{1.01F, 0.01F, 0}}));
  EXPECT_NEAR(mapper.map().local_from_robot.x, 1.0, 1e-9);
  mapper.reset();
  EXPECT_EQ(mapper.map().epoch, 0);
}

/// One hit 1 m above the robot's origin, seen by a robot that tilts.
Observation tilted(const Pose3& odom_from_robot) {
  Observation observation;
  observation.odom_from_robot = odom_from_robot;
  observation.scan.hits.push_back({0.0F, 0.0F, 1.0F});
  return observation;
}

TEST(Odometry, FollowsOdometryInSpace) {
  Odometry mapper({}, {.map = nullptr, .motion = Motion::free});
  const Pose3 first({1, 2, 3}, exponential({0.1, 0.2, 0.3}));
  const Pose3 step({0.5, -0.1, 0.2}, exponential({-0.1, 0.05, 0.2}));
  mapper.add(tilted(first));
  EXPECT_EQ(mapper.map().local_from_robot, Pose3{});
  mapper.add(tilted(first * step));
  const LocalMap& map = mapper.map();
  EXPECT_NEAR(distance(map.local_from_robot, step), 0.0, 1e-9);
  EXPECT_NEAR(rotation_between(map.local_from_robot, step), 0.0, 1e-7);
  ASSERT_THAT(map.ends, ElementsAre(1U, 2U));
  EXPECT_EQ(map.points[0], (Point{0.0F, 0.0F, 1.0F}));
  const Vector3 hit = step * Vector3{0, 0, 1};
  EXPECT_NEAR(map.points.x[1], hit.x(), 1e-6);
  EXPECT_NEAR(map.points.y[1], hit.y(), 1e-6);
  EXPECT_NEAR(map.points.z[1], hit.z(), 1e-6);
  EXPECT_TRUE(map.normals.empty());
}

TEST(Odometry, KeepsWhatIsUpWhereTheMotionIsUpright) {
  Odometry mapper({}, {.map = nullptr, .motion = Motion::upright});
  const Pose3 first({1, 2, 3}, turn_about_z(0.7) * exponential({0.1, 0.2, 0.0}));
  const Pose3 second({2, 2, 3}, turn_about_z(0.9) * exponential({-0.1, 0.1, 0.0}));
  mapper.add(tilted(first));
  EXPECT_EQ(mapper.map().local_from_robot.translation(), Vector3::Zero());
  EXPECT_NEAR(mapper.map().local_from_robot.heading(), 0.0, 1e-12);
  EXPECT_NEAR(mapper.map().local_from_robot.tilt(), first.tilt(), 1e-12);
  mapper.add(tilted(second));
  EXPECT_NEAR(mapper.map().local_from_robot.tilt(), second.tilt(), 1e-12);
  EXPECT_NEAR(mapper.map().local_from_robot.translation().norm(), 1.0, 1e-12);
  EXPECT_NEAR(mapper.map().local_from_robot.z, 0.0, 1e-12);
}

}  // namespace
}  // namespace glocal::local_mappers::odometry_test
