#include "sources/clouds/trajectory_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "files.hpp"

namespace glocal::clouds::trajectory_file_test {
namespace {

Trajectory parse(const std::string& content) {
  return parse_trajectory(content, "a.txt");
}

std::string fault(const std::string& content) {
  return test::config_error("", [&] { static_cast<void>(parse(content)); });
}

TEST(TrajectoryFile, ReadsPosesOfTum) {
  const Trajectory t =
      parse("# stamp tx ty tz qx qy qz qw\n1.5 1 2 3 0 0 0.6 0.8\r\n\n1.5 0 0 0 0 0 0 -1.0005\n");
  ASSERT_EQ(t.poses.size(), 2U);
  EXPECT_TRUE(t.has_stamps);
  EXPECT_EQ(t.poses[0].stamp, 1.5);
  EXPECT_EQ(t.poses[0].pose, Pose3({1.0, 2.0, 3.0}, {0.8, 0.0, 0.0, 0.6}));
  EXPECT_EQ(t.poses[1].pose.rotation, (Quaternion{-1.0, 0.0, 0.0, 0.0}));
}

TEST(TrajectoryFile, ReadsPosesOfKitti) {
  const Trajectory t = parse("1 0 0 4 0 1 0 5 0 0 1 6\n0 -1 0 0 1 0 0 0 0 0 1 0\n");
  ASSERT_EQ(t.poses.size(), 2U);
  EXPECT_FALSE(t.has_stamps);
  EXPECT_EQ(t.poses[1].stamp, 1.0);
  EXPECT_EQ(t.poses[0].pose, Pose3(Vector3{4.0, 5.0, 6.0}));
  EXPECT_NEAR(t.poses[1].pose.heading(), std::numbers::pi / 2, 1e-12);
}

TEST(TrajectoryFile, RefusesLinesThatAreNoPoses) {
  EXPECT_EQ(fault("# nothing\n\n"), "a.txt: error: has no poses; TUM's or KITTI's are needed, one a line");
  EXPECT_EQ(
      fault("\n1 2 3\n"),
      "a.txt:2: error: has 3 values; TUM's poses have 8 (stamp tx ty tz qx qy qz qw), KITTI's 12 (three "
      "rows of four)");
  EXPECT_EQ(fault("1 0 0 4 0 1 0 5 0 0 1 6\n0 0 0 0 0 0 0 1\n"),
            "a.txt:2: error: has 8 values, the poses before have 12; put the line right or delete it");
  EXPECT_EQ(fault("0 0 0 0 0 0 0 one\n"), "a.txt:1: error: 'one' is not a finite number");
  EXPECT_EQ(fault("nan 0 0 0 0 0 0 1\n"), "a.txt:1: error: 'nan' is not a finite number");
  EXPECT_EQ(fault("0 2e7 0 0 0 0 0 1\n"),
            "a.txt:1: error: has a coordinate of 2e+07 m, at most 1e+07 are allowed");
}

TEST(TrajectoryFile, RefusesRotationsThatAreNone) {
  EXPECT_EQ(fault("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0.1 1\n"),
            "a.txt:2: error: the quaternion has a length of 1.005 instead of 1; its order is qx qy qz qw");
  EXPECT_EQ(fault("0 0 0 0 0 0 0 0\n"),
            "a.txt:1: error: the quaternion has a length of 0 instead of 1; its order is qx qy qz qw");
  const std::string no_rotation =
      "a.txt:1: error: the first three columns are no rotation matrix; get a fresh copy";
  EXPECT_EQ(fault("1 0 0 0 0 1 0 0 0 0 -1 0\n"), no_rotation);
  EXPECT_EQ(fault("1 0.01 0 0 0 1 0 0 0 0 1 0\n"), no_rotation);
  EXPECT_EQ(fault("2 0 0 0 0 2 0 0 0 0 2 0\n"), no_rotation);
}

TEST(TrajectoryFile, RefusesStampsThatFall) {
  EXPECT_EQ(fault("1.5 0 0 0 0 0 0 1\n0.5 0 0 0 0 0 0 1\n"),
            "a.txt:2: error: the stamp 0.5 is before 1.5, that of the pose before; sort the lines");
}

TEST(TrajectoryFile, OfTheDatasetsIsRead) {
  const auto folder = test::dataset("lidar3d");
  if (folder.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const Trajectory truth = read_trajectory(folder / "fr_079/drives/d0/poses.tum");
  ASSERT_EQ(truth.poses.size(), 25U);
  EXPECT_EQ(truth.poses[2].stamp, 2.0);
  EXPECT_EQ(truth.poses[2].pose.x, 7.25);
  EXPECT_LT(truth.poses[2].pose.tilt(), 0.06);
}

}  // namespace
}  // namespace glocal::clouds::trajectory_file_test
