#include "local_mappers/lidar_odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "files.hpp"
#include "local_mappers/scanned_room.hpp"
#include "sources/clouds/cloud_drive.hpp"

namespace glocal::local_mappers::lidar_odometry_test {
namespace {

StageSetup in_space() {
  return {.map = nullptr, .motion = Motion::free};
}

const test::SpatialDrive& drive() {
  static const test::SpatialDrive driven = test::drive_around_table(24);
  return driven;
}

/// How far the way from the first to the last pose is off.
struct Drift {
  double metres = 0.0;
  double degrees = 0.0;
};

Drift drift(const Pose3& first_from_last) {
  const Pose3 truth = inverse(drive().map_from_robot.front()) * drive().map_from_robot.back();
  return {distance(first_from_last, truth), degrees(rotation_between(first_from_last, truth))};
}

Drift drift_of_odometry() {
  return drift(inverse(drive().observations.front().odom_from_robot) *
               drive().observations.back().odom_from_robot);
}

LocalMap driven(LidarOdometry& mapper) {
  for (const Observation& observation : drive().observations) mapper.add(observation);
  return mapper.map();
}

TEST(LidarOdometry, DriftsFarLessThanOdometry) {
  LidarOdometry mapper({}, in_space());
  const Drift scans = drift(driven(mapper).local_from_robot);
  const Drift wheels = drift_of_odometry();
  EXPECT_GT(wheels.metres, 0.4);
  EXPECT_GT(wheels.degrees, 10.0);
  EXPECT_LT(scans.metres, 0.03);
  EXPECT_LT(scans.degrees, 0.3);
}

TEST(LidarOdometry, DoesWithoutOdometry) {
  for (const char* prediction : {"constant_velocity", "either"}) {
    LidarOdometry::Params params;
    params.prediction = prediction;
    LidarOdometry mapper(params, in_space());
    for (Observation observation : drive().observations) {
      observation.odom_from_robot = {};
      mapper.add(observation);
    }
    const Drift scans = drift(mapper.map().local_from_robot);
    EXPECT_EQ(mapper.map().epoch, 0) << prediction;
    EXPECT_LT(scans.metres, 0.03) << prediction;
    EXPECT_LT(scans.degrees, 0.3) << prediction;
  }
}

TEST(LidarOdometry, BelievesOdometryWhereScansSayNothing) {
  LidarOdometry mapper({}, in_space());
  const Pose3 step({0.5, 0.1, 0.2}, exponential({0.1, 0.0, 0.2}));
  Observation observation = drive().observations.front();
  mapper.add(observation);
  const LocalMap before = mapper.map();
  EXPECT_EQ(before.local_from_robot, Pose3{});
  observation.odom_from_robot = observation.odom_from_robot * step;
  observation.scan.hits.clear();
  mapper.add(observation);
  const LocalMap& after = mapper.map();
  EXPECT_EQ(after.points, before.points);
  EXPECT_NEAR(distance(after.local_from_robot, step), 0.0, 1e-9);
  EXPECT_NEAR(rotation_between(after.local_from_robot, step), 0.0, 1e-7);
  EXPECT_EQ(after.ends.size(), 2U);
}

TEST(LidarOdometry, KeepsPointsInOrderAndHasUnitNormals) {
  LidarOdometry mapper({}, in_space());
  std::size_t observations = 0;
  Points before;
  for (const Observation& observation : drive().observations) {
    mapper.add(observation);
    const LocalMap& map = mapper.map();
    ASSERT_EQ(map.ends.size(), ++observations);
    ASSERT_EQ(map.ends.back(), map.points.size());
    ASSERT_EQ(map.normals.size(), map.points.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vector3 moved_by{map.points.x[i] - before.x[i], map.points.y[i] - before.y[i],
                             map.points.z[i] - before.z[i]};
      ASSERT_LE(moved_by.norm(), std::sqrt(3.0) * SurfaceMapParams{}.resolution);
    }
    before = map.points;
  }
  std::size_t with_normal = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Point n = mapper.map().normals[i];
    if (n == Point{}) continue;
    ++with_normal;
    ASSERT_NEAR(Vector3(n.x, n.y, n.z).norm(), 1.0, 1e-5);
  }
  EXPECT_GT(with_normal, before.size() / 2);
}

TEST(LidarOdometry, HasUpWhereOdometryHasIt) {
  LidarOdometry mapper({}, {.map = nullptr, .motion = Motion::upright});
  mapper.add(drive().observations.front());
  const Pose3& odom = drive().observations.front().odom_from_robot;
  EXPECT_GT(odom.tilt(), radians(0.5));
  EXPECT_EQ(mapper.map().local_from_robot.translation(), Vector3::Zero());
  EXPECT_NEAR(mapper.map().local_from_robot.heading(), 0.0, 1e-9);
  EXPECT_NEAR(mapper.map().local_from_robot.tilt(), odom.tilt(), 1e-9);
}

TEST(LidarOdometry, ForgetsWhatItHasNotSeenForLong) {
  LidarOdometry::Params params;
  params.distance = 0.0;
  params.scans = 1;
  LidarOdometry forgetful(params, in_space());
  LidarOdometry mapper({}, in_space());
  const std::size_t all = driven(mapper).points.size();
  const LocalMap map = driven(forgetful);
  EXPECT_LT(map.points.size(), all / 2);
  EXPECT_TRUE(std::is_sorted(map.ends.begin(), map.ends.end()));
  EXPECT_EQ(map.ends.back(), map.points.size());
  EXPECT_EQ(map.epoch, 0);
}

TEST(LidarOdometry, StartsOverWhereNothingFits) {
  LidarOdometry::Params params;
  params.restart_after = 2;
  LidarOdometry mapper(params, in_space());
  Observation observation = drive().observations.front();
  mapper.add(observation);
  const std::size_t points = mapper.map().points.size();
  // Somebody has carried the robot into a hall ten times as large; odometry has not noticed.
  std::vector<test::Box> hall = {{{-50, -50, -30}, {50, 60, 40}}};
  Rng rng(1);
  observation.scan = test::ring_scan(hall, {}, 0.01, rng);
  mapper.add(observation);
  EXPECT_EQ(mapper.map().epoch, 0);
  EXPECT_EQ(mapper.map().points.size(), points);
  mapper.add(observation);
  EXPECT_EQ(mapper.map().epoch, 1);
  EXPECT_EQ(mapper.map().ends.size(), 1U);
  EXPECT_GT(mapper.map().points.size(), 0U);
}

TEST(LidarOdometry, RepeatsItselfAfterAReset) {
  LidarOdometry mapper({}, in_space());
  const LocalMap first = driven(mapper);
  mapper.reset();
  EXPECT_TRUE(mapper.map().points.empty());
  EXPECT_TRUE(mapper.map().ends.empty());
  EXPECT_EQ(mapper.map().epoch, 0);
  const LocalMap second = driven(mapper);
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.normals, second.normals);
  EXPECT_EQ(first.ends, second.ends);
  EXPECT_EQ(first.local_from_robot, second.local_from_robot);
}

TEST(LidarOdometry, HalvesTheDriftOfARecordedDrive) {
  const std::filesystem::path folder = test::dataset("lidar3d/fr_079/drives/d7");
  if (folder.empty() || !std::filesystem::exists(folder)) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  clouds::CloudDrive::Params params;
  params.folder = test::file_path(folder);
  params.odometry = test::file_path(folder / "odom.tum");
  params.reference = test::file_path(folder / "poses.tum");
  params.voxel_size = 0.0;
  clouds::CloudDrive source(params, {});
  LidarOdometry mapper({}, in_space());
  std::vector<Sample> samples;
  while (auto sample = source.next()) {
    mapper.add(sample->observation);
    sample->observation.scan = {};
    samples.push_back(*std::move(sample));
  }
  ASSERT_EQ(samples.size(), 25U);
  const Pose3 truth = inverse(*samples.front().map_from_robot) * *samples.back().map_from_robot;
  const Pose3 wheels =
      inverse(samples.front().observation.odom_from_robot) * samples.back().observation.odom_from_robot;
  EXPECT_LT(distance(mapper.map().local_from_robot, truth), distance(wheels, truth) / 2.0);
  EXPECT_LT(rotation_between(mapper.map().local_from_robot, truth), rotation_between(wheels, truth) / 2.0);
}

TEST(AdaptiveThreshold, IsTheRootMeanSquareOfCorrections) {
  AdaptiveThreshold threshold(0.3, 0.05);
  EXPECT_DOUBLE_EQ(threshold.sigma(), 0.3);
  threshold.note(Pose3(Vector3{0.04, 0.0, 0.0}), 10.0);
  EXPECT_DOUBLE_EQ(threshold.sigma(), 0.3) << "too small to count";
  threshold.note({{0.0, 0.1, 0.0}, exponential({0.0, 0.0, 0.1})}, 10.0);
  const double delta = 0.1 + 20.0 * std::sin(0.05);
  EXPECT_NEAR(threshold.sigma(), std::sqrt((0.09 + delta * delta) / 2.0), 1e-12);
}

}  // namespace
}  // namespace glocal::local_mappers::lidar_odometry_test
