#include "sources/bags/drive_contents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "sources/bags/message_writer.hpp"

namespace glocal::test::bags::drive_contents_test {
namespace {

using glocal::bags::DriveContents;
using glocal::bags::DriveTopics;
using glocal::bags::read_contents;
using glocal::bags::Recording;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t second = 1'000'000'000;

class DriveOf : public testing::Test {
 protected:
  DriveContents read(const DriveTopics& wanted = {}) {
    Recording recording(folder_.write("drive.mcap", recording_.bytes()));
    return read_contents(recording, wanted, (folder_ / "drive.mcap").string(),
                         [this](const std::string& text) { remarks_.push_back(text); });
  }
  std::string fault(const DriveTopics& wanted = {}) {
    return config_error(folder_.path(), [&] { read(wanted); });
  }
  /// Odometry by tf, and a laser on the robot.
  void add_robot(const std::string& base) {
    for (const int s : {0, 1}) recording_.transform("odom", base, s * second, Pose2{1.0 * s, 0.0, 0.0});
    recording_.transform(base, "laser", 0, {}, "/tf_static");
  }

  TemporaryFolder folder_;
  RobotRecording recording_;
  std::vector<std::string> remarks_;
};

TEST_F(DriveOf, ARobotIsFoundOutFromTf) {
  add_robot("base_link");
  recording_.scan("/scan", second, {.ranges = {1.0F}});
  recording_.scan("/scan", 2 * second, {.ranges = {1.0F}});
  const DriveContents contents = read();
  ASSERT_EQ(contents.scans.size(), 1U);
  EXPECT_EQ(contents.scans[0].topic, "/scan");
  EXPECT_EQ(contents.scans[0].frame, "laser");
  EXPECT_FALSE(contents.scans[0].are_clouds);
  EXPECT_THAT(contents.scans[0].stamps_ns, ElementsAre(second, 2 * second));
  EXPECT_EQ(contents.base_frame, "base_link");
  EXPECT_EQ(contents.odom_frame, "odom");
  EXPECT_NEAR(contents.odometry_at(second / 2, second)->x, 0.5, 1e-12);
  EXPECT_THAT(remarks_, IsEmpty());
}

TEST_F(DriveOf, OdometryOfATopicServesWhereTfHasNone) {
  for (const int s : {0, 1})
    recording_.odometry("/wheels", s * second, "start", "axle", Pose2{1.0 * s, 0.0, 0.0});
  recording_.transform("axle", "base", 0, Pose2{0.0, 0.5, 0.0}, "/tf_static");
  recording_.transform("base", "laser", 0, {}, "/tf_static");
  recording_.scan("/scan", second, {.ranges = {1.0F}});
  EXPECT_EQ(read().base_frame, "axle");
  const DriveContents contents = read({.base_frame = "base"});
  EXPECT_EQ(contents.odometry, "/wheels");
  EXPECT_EQ(contents.odom_frame, "start");
  EXPECT_NEAR(contents.odometry_at(second / 2, second)->x, 0.5, 1e-12);
  EXPECT_NEAR(contents.odometry_at(second / 2, second)->y, 0.5, 1e-12);
}

TEST_F(DriveOf, OdometryThatNamesNoChildFrameIsTheRobots) {
  recording_.transform("base_link", "laser", 0, {}, "/tf_static");
  recording_.odometry("/odom", 0, "odom", "", {});
  recording_.scan("/scan", 0, {.ranges = {1.0F}});
  EXPECT_EQ(read().base_frame, "base_link");
  EXPECT_EQ(read({.base_frame = "laser"}).base_frame, "laser");
  recording_.transform("base_footprint", "base_link", 0, {}, "/tf_static");
  EXPECT_EQ(read().base_frame, "base_footprint");
}

TEST_F(DriveOf, OneTopicOfSeveralWithScansIsToBeNamed) {
  add_robot("base_link");
  for (const int s : {0, 1, 2})
    recording_.scan("/front", s * second, {.angle_increment = 0.1F, .ranges = {1.0F, 1.0F}});
  recording_.cloud("/points", 0, "laser", {{1.0, 0.0, 0.0}});
  EXPECT_THAT(
      fault(),
      HasSubstr("drive.mcap: error: has several topics with scans; set scans to those of one sensor"));
  EXPECT_THAT(fault(), HasSubstr("/front: 1.0 Hz, 2 beams over 5.7 deg, range 0.00 to 30.00 m, frame laser"));
  EXPECT_THAT(fault(), HasSubstr("/points: 0.0 Hz, sensor_msgs/PointCloud2, frame laser"));
  EXPECT_TRUE(read({.scans = {"/points"}}).scans[0].are_clouds);
}

TEST_F(DriveOf, TopicsThatAreNotThereAreToldWithThoseThatAre) {
  add_robot("base_link");
  recording_.scan("/scan", 0, {.ranges = {1.0F}});
  EXPECT_THAT(fault({.scans = {"/scn"}}),
              HasSubstr("has no topic /scn with scans; set scans to one of /scan"));
  EXPECT_THAT(fault({.odometry = "/odom"}),
              HasSubstr("has no topic /odom with nav_msgs/Odometry; it has none at all"));
  EXPECT_THAT(fault({.reference = "/truth"}),
              HasSubstr("has no topic /truth with poses; it has none at all"));
}

TEST_F(DriveOf, ARecordingWithoutScansIsNone) {
  add_robot("base_link");
  EXPECT_THAT(fault(), HasSubstr("has no scans"));
}

TEST_F(DriveOf, FramesThatTfDoesNotConnectAreToldWithTheTree) {
  recording_.scan("/scan", 0, {.ranges = {1.0F}});
  EXPECT_THAT(fault(), HasSubstr("tf does not connect odom with base_footprint or base_link"));
  EXPECT_THAT(fault(), HasSubstr("the tree, which is\nempty"));
  add_robot("robot");
  EXPECT_THAT(fault(), HasSubstr("odom\n  robot\n    laser\n"));
  EXPECT_EQ(read({.base_frame = "robot"}).base_frame, "robot");
}

TEST_F(DriveOf, OneOfSeveralOdometriesIsToBeNamed) {
  for (const char* topic : {"/a", "/b"}) recording_.odometry(topic, 0, "odom", "laser", {});
  recording_.scan("/scan", 0, {.ranges = {1.0F}});
  EXPECT_THAT(fault(), HasSubstr("has several topics with odometry; set odometry to one of /a, /b"));
  EXPECT_EQ(read({.odometry = "/b"}).odometry, "/b");
}

TEST_F(DriveOf, MessagesThatCannotBeReadAreCounted) {
  add_robot("base_link");
  for (const int s : {3, 4})
    recording_.transform("odom", "base_link", s * second, Pose3(Quaternion{0.0, 0.0, 0.0, 0.0}));
  recording_.scan("/scan", 0, {.ranges = {1.0F}});
  EXPECT_FALSE(read().odometry_at(3 * second, second));
  EXPECT_THAT(remarks_, ElementsAre(HasSubstr("2 messages of /tf are left out; the first: ")));
}

}  // namespace
}  // namespace glocal::test::bags::drive_contents_test
