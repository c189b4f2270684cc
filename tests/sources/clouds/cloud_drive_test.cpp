#include "sources/clouds/cloud_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"
#include "glocal/yaml.hpp"
#include "samples.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::clouds::cloud_drive_test {
namespace {

using testing::ElementsAre;

class CloudDriveTest : public testing::Test {
 protected:
  CloudDriveTest() { params_.folder = test::file_path(folder_.path()); }

  /// Clouds of three points: 0.1, 2 and 200 m before the sensor.
  void write_clouds(int n) {
    Points points;
    for (const float x : {0.1F, 2.0F, 200.0F}) points.push_back({x, 0.0F, 0.0F});
    for (int i = 0; i < n; ++i) folder_.write(std::to_string(i) + ".pcd", pcd(points));
  }
  /// A line for each pose, with stamps 0, 1 …
  FilePath write_poses(const std::string& name, const std::vector<std::string>& poses) {
    std::string text;
    for (std::size_t i = 0; i < poses.size(); ++i) text += std::to_string(i) + " " + poses[i] + "\n";
    return test::file_path(folder_.write(name, text));
  }
  std::vector<Sample> read() {
    const SourceSetup setup{.note_input = [&](const auto& file) { inputs_.push_back(file.filename()); }};
    CloudDrive drive(params_, setup);
    return test::all_of(drive);
  }
  static void expect_near(const Pose3& a, const Pose3& b) {
    EXPECT_NEAR(distance(a, b), 0.0, 1e-9);
    EXPECT_NEAR(rotation_between(a, b), 0.0, 1e-7);
  }

  test::TemporaryFolder folder_;
  CloudDrive::Params params_;
  std::vector<std::string> inputs_;
};

TEST_F(CloudDriveTest, ACloudMayHaveNoPoints) {
  write_clouds(3);
  folder_.write("1.pcd", pcd(Points{}));
  const auto samples = read();
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[1].observation.scan.hits.size(), 0U);
  EXPECT_EQ(samples[2].observation.scan.hits.size(), samples[0].observation.scan.hits.size());
}

TEST_F(CloudDriveTest, RefusesTimesThatCannotBe) {
  folder_.write("0.pcd",
                "VERSION .7\nFIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
                "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 0 0 0\n2 0 0 1e8\n");
  EXPECT_EQ(
      test::config_error(folder_.path(), [&] { static_cast<void>(read()); }),
      "0.pcd: error: its readings' times are from 0 to 1e+08 s, at most 1000 s apart are allowed; write "
      "decimals in seconds, or whole numbers in nanoseconds");
  std::filesystem::rename(folder_.path() / "0.pcd", folder_.path() / "10000000000.pcd");
  EXPECT_THAT(test::config_error(folder_.path(), [&] { static_cast<void>(read()); }),
              testing::StartsWith("10000000000.pcd: error: "));
}

TEST_F(CloudDriveTest, WithoutOdometryIsSingleClouds) {
  write_clouds(3);
  const auto samples = read();
  ASSERT_EQ(samples.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const Sample& sample = samples[static_cast<std::size_t>(i)];
    EXPECT_EQ(sample.segment, i);
    EXPECT_EQ(sample.observation.stamp, i);
    EXPECT_EQ(sample.observation.odom_from_robot, Pose3{});
    EXPECT_FALSE(sample.map_from_robot);
  }
}

TEST_F(CloudDriveTest, KeepsTheTimesOfPoints) {
  folder_.write(
      "0.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property double time\nend_header\n1 0 0 10.00\n0.1 0 0 10.01\n1.02 0 0 10.04\n3 0 0 10.10\n");
  params_.voxel_size = 0.0;
  EXPECT_THAT(read()[0].observation.scan.times, ElementsAre(0.0F, 0.04F, 0.1F)) << "without the near point";
  params_.stamp_of = "last_point";
  EXPECT_THAT(read()[0].observation.scan.times,
              testing::Pointwise(testing::FloatNear(1e-6F), {-0.1F, -0.06F, 0.0F}));
  params_.voxel_size = 0.5;
  const Scan scan = read()[0].observation.scan;
  EXPECT_THAT(scan.hits.x, testing::Pointwise(testing::FloatNear(1e-6F), {1.01F, 3.0F}));
  EXPECT_THAT(scan.times, testing::Pointwise(testing::FloatNear(1e-6F), {-0.08F, 0.0F}));
}

TEST_F(CloudDriveTest, TakesKeyframesByOdometry) {
  write_clouds(5);
  params_.odometry =
      write_poses("odom.tum", {"0 0 0 0 0 0 1", "0 0 0.2 0 0 0 1", "0 0 0.3 0 0 0 1",
                               "0 0 0.3 0.1494381 0 0 0.9887711", "0 0 0.35 0.1494381 0 0 0.9887711"});
  params_.reference = write_poses(
      "poses.tum", {"9 0 0 0 0 0 1", "9 1 0 0 0 0 1", "9 2 0 0 0 0 1", "9 3 0 0 0 0 1", "9 4 0 0 0 0 1"});
  const auto samples = read();
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[1].observation.stamp, 2.0);
  EXPECT_EQ(samples[1].map_from_robot->y, 2.0);
  EXPECT_EQ(samples[2].observation.stamp, 3.0);
  EXPECT_NEAR(samples[2].observation.odom_from_robot.tilt(), 0.3, 1e-5);
  EXPECT_EQ(samples[2].segment, 0);
  EXPECT_THAT(inputs_,
              ElementsAre(folder_.path().filename(), "odom.tum", "poses.tum", "0.pcd", "2.pcd", "3.pcd"));
}

TEST_F(CloudDriveTest, DeliversPointsInTheFrameOfTheRobot) {
  write_clouds(1);
  params_.sensor = {.x = 0.5, .z = 1.0, .pitch_deg = 90.0};
  const Scan scan = read()[0].observation.scan;
  ASSERT_EQ(scan.hits.size(), 1U);  // The others are too near and too far.
  EXPECT_NEAR(scan.hits.x[0], 0.5, 1e-6);
  EXPECT_NEAR(scan.hits.z[0], -1.0, 1e-6);
  EXPECT_EQ(scan.origin, (Point{0.5F, 0.0F, 1.0F}));
  EXPECT_TRUE(scan.free_ends.empty());
}

TEST_F(CloudDriveTest, MovesPosesOfTheSensorToTheRobot) {
  write_clouds(2);
  const std::vector<std::string> poses = {"1 0 0 0 0 0 1", "3 0 0 0 0 0.7071068 0.7071068"};
  params_.odometry = write_poses("odom.tum", poses);
  params_.reference = write_poses("poses.tum", poses);
  params_.sensor = {.x = 1.0, .yaw_deg = 90.0};
  EXPECT_EQ(read()[0].map_from_robot->x, 1.0);
  params_.poses_of = "sensor";
  const auto samples = read();
  // The sensor looks along x of the map, so that the robot looks along -y; the sensor is before it.
  expect_near(*samples[0].map_from_robot, Pose2{1.0, 1.0, -std::numbers::pi / 2});
  expect_near(samples[1].observation.odom_from_robot, Pose2{2.0, 0.0, 0.0});
}

TEST_F(CloudDriveTest, TurnsTheSensorByRollPitchAndYaw) {
  const Pose3 mount = robot_from_sensor({.roll_deg = 90.0, .pitch_deg = 30.0, .yaw_deg = 90.0});
  // Forward is to the left and down; left is up, leaning forward (seen along y).
  const Vector3 forward = mount * Vector3{1.0, 0.0, 0.0};
  EXPECT_NEAR(forward.y(), std::cos(std::numbers::pi / 6), 1e-12);
  EXPECT_NEAR(forward.z(), -0.5, 1e-12);
  EXPECT_NEAR((mount * Vector3{0.0, 1.0, 0.0}).z(), std::cos(std::numbers::pi / 6), 1e-12);
}

TEST_F(CloudDriveTest, NeedsAFolder) {
  const auto fault = [&](const std::string& folder) {
    const auto file = folder_.write("drive.yaml", "folder: " + folder + "\n");
    ParamsOf<CloudDrive::Params> params;
    return test::config_error(folder_.path(), [&] { read_yaml(file, params); });
  };
  EXPECT_EQ(fault("."), "");
  EXPECT_EQ(fault("none"), "drive.yaml:1:9: error: folder: is no folder: none");
  EXPECT_EQ(fault("drive.yaml"), "drive.yaml:1:9: error: folder: is no folder: drive.yaml");
}

TEST_F(CloudDriveTest, IsRefusedWhereACloudIsNone) {
  folder_.write("0.pcd", "nothing");
  EXPECT_EQ(
      test::config_error(folder_.path(), [&] { static_cast<void>(read()); }),
      "0.pcd: error: is neither a PCD file, a PLY file nor an octree (.bt) by its first line, nor a cloud of "
      "KITTI by its name (*.bin); convert it to one of them");
}

/// The scans were made in the map: each point is near one of the map's, at the reference pose.
TEST_F(CloudDriveTest, OfTheDatasetsLiesOnItsMap) {
  const auto data = test::dataset("lidar3d/fr_079");
  if (data.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  params_.folder = test::file_path(data / "drives/d3");
  params_.odometry = test::file_path(data / "drives/d3/odom.tum");
  params_.reference = test::file_path(data / "drives/d3/poses.tum");
  params_.voxel_size = 0.0;
  const auto samples = read();
  ASSERT_EQ(samples.size(), 25U);
  const Sample& sample = samples[20];
  const Points map = read_cloud(data / "map.pcd").points;
  std::size_t near = 0, tested = 0;
  for (std::size_t i = 0; i < sample.observation.scan.hits.size(); i += 97, ++tested) {
    const Point hit = sample.observation.scan.hits[i];
    const Vector3 p = *sample.map_from_robot * Vector3{hit.x, hit.y, hit.z};
    bool found = false;
    for (std::size_t j = 0; j < map.size() && !found; ++j)
      found = (p - Vector3{map.x[j], map.y[j], map.z[j]}).norm() < 0.1;
    near += found ? 1U : 0U;
  }
  EXPECT_GT(static_cast<double>(near), 0.95 * static_cast<double>(tested));
}

}  // namespace
}  // namespace glocal::clouds::cloud_drive_test
