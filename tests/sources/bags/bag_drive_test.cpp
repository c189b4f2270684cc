#include "sources/bags/bag_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "files.hpp"
#include "glocal/distance_field.hpp"
#include "samples.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/ros_map/ros_map.hpp"

namespace glocal::test::bags::bag_drive_test {
namespace {

using glocal::bags::BagDrive;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t second = 1000 * ms;

class Bags : public testing::Test {
 protected:
  Bags() { params_.keyframes = {0.0, 0.0}; }

  /// Odometry by tf, ten times a second.
  void drive(double metres_a_second, double rad_a_second, int seconds) {
    for (int i = 0; i <= 10 * seconds; ++i) {
      const double t = 0.1 * i;
      recording_.transform("odom", "base_link", 100 * ms * i,
                           Pose2{metres_a_second * t, 0.0, rad_a_second * t});
    }
  }
  void mount(const Pose3& base_from_laser) {
    recording_.transform("base_link", "laser", 0, base_from_laser, "/tf_static");
  }
  std::vector<Sample> read(Motion motion = Motion::planar) {
    params_.path = file_path(folder_.write("drive.mcap", recording_.bytes()));
    BagDrive source(params_,
                    {.motion = motion, .warn = [&](const std::string& text) { warnings_.push_back(text); }});
    return all_of(source);
  }
  std::string fault() {
    return config_error(folder_.path(), [&] { read(); });
  }

  TemporaryFolder folder_;
  RobotRecording recording_;
  BagDrive::Params params_;
  std::vector<std::string> warnings_;
};

TEST_F(Bags, GiveScansInTheRobotsFrameWithOdometry) {
  drive(1.0, 0.0, 2);
  mount(Pose2{0.25, 0.0, std::numbers::pi / 2.0});
  recording_.scan("/scan", 550 * ms, {.ranges = {2.0F}});
  const auto samples = read();
  ASSERT_EQ(samples.size(), 1U);
  const Observation& o = samples[0].observation;
  EXPECT_DOUBLE_EQ(o.stamp, 0.55);
  EXPECT_NEAR(o.odom_from_robot.x, 0.55, 1e-9);
  ASSERT_EQ(o.scan.hits.size(), 1U);
  EXPECT_NEAR(o.scan.hits.x[0], 0.25, 1e-6);
  EXPECT_NEAR(o.scan.hits.y[0], 2.0, 1e-6);
  EXPECT_NEAR(o.scan.origin.x, 0.25, 1e-6);
  EXPECT_TRUE(o.scan.times.empty());
  EXPECT_FALSE(samples[0].map_from_robot);
  EXPECT_THAT(warnings_, IsEmpty());
}

/// What a laser on the robot measures of the wall x = 5 while the robot drives and turns; a ray every 10 ms.
ScanFields wall_in_motion(double from_s, double metres_a_second, double rad_a_second) {
  ScanFields fields{.angle_min = -0.5F, .angle_increment = 0.05F, .time_increment = 0.01F, .ranges = {}};
  for (int i = 0; i < 20; ++i) {
    const double t = from_s + 0.01 * i;
    const double heading = rad_a_second * t;
    const double x = metres_a_second * t + 0.2 * std::cos(heading);
    fields.ranges.push_back(static_cast<float>((5.0 - x) / std::cos(heading - 0.5 + 0.05 * i)));
  }
  return fields;
}

TEST_F(Bags, ScansInMotionAreDeskewedByOdometry) {
  drive(1.0, 0.4, 2);
  mount(Pose2{0.2, 0.0, 0.0});
  recording_.scan("/scan", 500 * ms, wall_in_motion(0.5, 1.0, 0.4));
  const Observation o = read().at(0).observation;
  const Points in_odom = moved(o.scan.hits, o.odom_from_robot);
  ASSERT_EQ(in_odom.size(), 20U);
  // Less than a tenth of a millimetre is from taking the motion in a scan to be straight.
  for (const float x : in_odom.x) EXPECT_NEAR(x, 5.0, 1e-3);
  EXPECT_TRUE(o.scan.times.empty());
}

TEST_F(Bags, ScansAreLeftAsMeasuredWithTheirTimesIfAskedFor) {
  drive(1.0, 0.4, 2);
  mount(Pose2{0.2, 0.0, 0.0});
  recording_.scan("/scan", 500 * ms, wall_in_motion(0.5, 1.0, 0.4));
  params_.deskew = "none";
  const Observation o = read().at(0).observation;
  const Points in_odom = moved(o.scan.hits, o.odom_from_robot);
  EXPECT_GT(std::abs(in_odom.x[19] - 5.0F), 0.05F);
  ASSERT_EQ(o.scan.times.size(), 20U);
  EXPECT_NEAR(o.scan.times[19], 0.19F, 1e-6F);
}

TEST_F(Bags, ALaserUpsideDownSeesLeftWhatIsLeft) {
  drive(0.0, 0.0, 1);
  mount({{0.0, 0.0, 0.3}, exponential({std::numbers::pi, 0.0, 0.0})});
  recording_.scan("/scan", 500 * ms, {.angle_min = -1.0F, .ranges = {2.0F}});
  const Scan scan = read().at(0).observation.scan;
  EXPECT_NEAR(scan.hits.y[0], 2.0 * std::sin(1.0), 1e-5);
  EXPECT_EQ(scan.hits.z[0], 0.0F);
}

TEST_F(Bags, KeyframesAndSegmentsAreThoseOfOdometry) {
  drive(1.0, 0.0, 4);
  mount({});
  for (int i = 0; i < 40; ++i) recording_.scan("/scan", 100 * ms * i, {.ranges = {2.0F}});
  params_.keyframes = {0.5, 90.0};
  params_.segments = {{0.0, 0.25}, {0.5, 1.0}};
  const auto samples = read();
  std::vector<double> stamps;
  std::vector<int> segments;
  for (const Sample& sample : samples) {
    stamps.push_back(std::round(10.0 * sample.observation.stamp));
    segments.push_back(sample.segment);
  }
  // 3.9 m are driven: the segments are [0, 0.975[ and [1.95, 3.9].
  EXPECT_THAT(stamps, ElementsAre(0, 5, 20, 25, 30, 35));
  EXPECT_THAT(segments, ElementsAre(0, 0, 1, 1, 1, 1));
}

TEST_F(Bags, ScansOfOtherTopicsJoinTheNearestObservation) {
  drive(1.0, 0.0, 2);
  mount(Pose2{0.5, 0.0, 0.0});
  recording_.transform("base_link", "back", 0, Pose2{-0.5, 0.0, std::numbers::pi}, "/tf_static");
  recording_.scan("/back", 450 * ms, {.frame = "back", .ranges = {1.0F}});
  recording_.scan("/front", 500 * ms, {.ranges = {2.0F}});
  recording_.scan("/back", 600 * ms, {.frame = "back", .ranges = {9.0F}});
  params_.scans = {"/front", "/back"};
  const auto samples = read();
  ASSERT_EQ(samples.size(), 1U);
  const Scan& scan = samples[0].observation.scan;
  ASSERT_EQ(scan.hits.size(), 2U);
  // The later scan ends 1 m behind a sensor that was 0.05 m farther back when it measured.
  const auto [back, front] = std::minmax_element(scan.hits.x.begin(), scan.hits.x.end());
  EXPECT_NEAR(*front, 2.5, 1e-6);
  EXPECT_NEAR(*back, -1.55, 1e-6);
  EXPECT_NEAR(scan.origin.x, -0.025, 1e-6);
}

TEST_F(Bags, AnObservationWithoutAScanOfTheOtherTopicIsTold) {
  drive(1.0, 0.0, 2);
  mount({});
  recording_.scan("/front", 500 * ms, {.ranges = {2.0F}});
  recording_.scan("/back", 1500 * ms, {.ranges = {1.0F}});
  params_.scans = {"/front", "/back"};
  EXPECT_EQ(read().at(0).observation.scan.hits.size(), 1U);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("1 of 1 observations are without a scan of /back")));
}

TEST_F(Bags, ReferencesAreOfATopicMovedAndShifted) {
  drive(1.0, 0.0, 2);
  mount({});
  for (int i = 0; i <= 20; ++i) recording_.pose("/truth", 100 * ms * i, "world", Pose2{0.1 * i, 0.0, 0.0});
  recording_.scan("/scan", 1000 * ms, {.ranges = {2.0F}});
  params_.reference = {.topic = "/truth", .x = 10.0, .yaw_deg = 90.0, .time_shift = 0.25};
  const auto reference = read().at(0).map_from_robot;
  ASSERT_TRUE(reference);
  // A pose that is stamped 0.75 s counts as one of 1 s.
  EXPECT_NEAR(reference->x, 10.0, 1e-9);
  EXPECT_NEAR(reference->y, 0.75, 1e-9);
  EXPECT_NEAR(degrees(reference->heading()), 90.0, 1e-9);
}

TEST_F(Bags, ReferencesAreOfAFrame) {
  drive(1.0, 0.0, 2);
  mount({});
  recording_.transform("odom", "map", 0, Pose2{0.0, 2.0, 0.0});
  recording_.scan("/scan", 1000 * ms, {.ranges = {2.0F}});
  params_.reference.frame = "map";
  EXPECT_NEAR(read().at(0).map_from_robot->y, -2.0, 1e-9);
}

TEST_F(Bags, AReferenceFrameThatTfDoesNotHaveIsRefused) {
  drive(1.0, 0.0, 2);
  mount({});
  recording_.scan("/scan", 1000 * ms, {.ranges = {2.0F}});
  params_.reference.frame = "mapp";
  EXPECT_THAT(fault(),
              HasSubstr("tf does not connect mapp with base_link; set reference to a topic or a frame"));
}

TEST_F(Bags, AReferenceThatEndsEarlyIsTold) {
  drive(1.0, 0.0, 2);
  mount({});
  for (const int i : {0, 5}) recording_.pose("/truth", 100 * ms * i, "world", Pose2{0.1 * i, 0.0, 0.0});
  for (const int i : {4, 8}) recording_.scan("/scan", 100 * ms * i, {.ranges = {2.0F}});
  params_.reference.topic = "/truth";
  const auto samples = read();
  EXPECT_TRUE(samples.at(0).map_from_robot);
  EXPECT_FALSE(samples.at(1).map_from_robot);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("1 of 2 observations are without reference pose")));
}

/// As where a pose was set by hand once, and where odometry ends while the robot stands.
TEST_F(Bags, PosesHoldOnlyNearTheirTimesThoughTheyAreAllAlike) {
  mount({});
  for (const int i : {0, 1, 2, 3})
    recording_.odometry("/odom", 500 * ms * i, "odom", "base_link", Pose2{1.0, 0.0, 0.0});
  recording_.pose("/truth", 500 * ms, "world", Pose2{3.0, 0.0, 0.0});
  for (const int i : {1, 2, 9}) recording_.scan("/scan", 500 * ms * i, {.ranges = {2.0F}});
  params_.reference.topic = "/truth";
  const auto samples = read();
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_TRUE(samples[0].map_from_robot);
  EXPECT_FALSE(samples[1].map_from_robot);
}

TEST_F(Bags, OdometryByTfHoldsOnlyAsLongAsItIsToldThoughTheRobotStands) {
  drive(0.0, 0.0, 2);
  mount({});
  for (const int i : {1, 2, 3}) recording_.scan("/scan", second * i, {.ranges = {2.0F}});
  EXPECT_EQ(read().size(), 2U);
  EXPECT_THAT(warnings_,
              ElementsAre(HasSubstr("1 of 3 scans are left out, as tf is not known within 0.5 s")));
}

TEST_F(Bags, AStampInTheFutureLeavesOutThatScanAlone) {
  drive(1.0, 0.0, 2);
  mount({});
  int received = 0;
  for (const int i : {2, 4000, 6, 8}) recording_.scan("/scan", 100 * ms * i, {.ranges = {2.0F}}, received++);
  EXPECT_EQ(read().size(), 3U);
  EXPECT_THAT(warnings_,
              ElementsAre(HasSubstr("1 of 4 scans are left out, as tf is not known within 0.5 s")));
}

TEST_F(Bags, StampsThatRunBackwardsAreToldAndLeftOut) {
  drive(1.0, 0.0, 2);
  mount({});
  int received = 0;
  for (const int i : {2, 4, 4, 3, 6}) recording_.scan("/scan", 100 * ms * i, {.ranges = {2.0F}}, received++);
  EXPECT_EQ(read().size(), 3U);
  EXPECT_THAT(warnings_,
              ElementsAre(HasSubstr("2 scans are left out, as their stamps stand still or run backwards")));
}

TEST_F(Bags, AfterAJumpOfTheClockADriveOfItsOwnBegins) {
  mount({});
  for (const std::int64_t hour : {0, 1}) {
    for (int i = 0; i <= 5; ++i)
      recording_.transform("odom", "base_link", 3600 * second * hour + 100 * ms * i,
                           Pose2{0.1 * i, 0.0, 0.0});
    for (const int i : {1, 2})
      recording_.scan("/scan", 3600 * second * hour + 100 * ms * i, {.ranges = {2.0F}});
  }
  const auto samples = read();
  ASSERT_EQ(samples.size(), 4U);
  EXPECT_EQ(samples[1].segment, 0);
  EXPECT_EQ(samples[2].segment, 1);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("stamps jump by 3600 s")));
}

TEST_F(Bags, ScansWithoutOdometryAreToldAndLeftOut) {
  drive(1.0, 0.0, 1);
  mount({});
  for (const int i : {5, 15}) recording_.scan("/scan", 100 * ms * i, {.ranges = {2.0F}});
  EXPECT_EQ(read().size(), 1U);
  EXPECT_THAT(warnings_,
              ElementsAre(HasSubstr("1 of 2 scans are left out, as tf is not known within 0.5 s")));
}

TEST_F(Bags, WithoutAnyScanThatHasOdometryNothingIsRead) {
  drive(1.0, 0.0, 1);
  mount({});
  recording_.scan("/scan", 3600 * second, {.ranges = {2.0F}});
  EXPECT_THAT(fault(),
              HasSubstr("drive.mcap: error: /scan has 1 scans, and for none of them is it known where"));
}

TEST_F(Bags, AScanWhoseEndIsAfterTheLastOdometryIsToldAndLeftOut) {
  drive(1.0, 0.0, 1);
  mount({});
  recording_.scan("/scan", 500 * ms, wall_in_motion(0.5, 1.0, 0.0));
  recording_.scan("/scan", 900 * ms, wall_in_motion(0.9, 1.0, 0.0));
  EXPECT_EQ(read().size(), 1U);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("the scan at 0.900 s is left out")));
}

TEST_F(Bags, DamagedScansAreToldAndLeftOut) {
  drive(1.0, 0.0, 1);
  mount({});
  recording_.scan("/scan", 300 * ms, {.ranges = {2.0F}});
  recording_.add("/scan", "sensor_msgs/msg/LaserScan", 500 * ms,
                 RobotRecording::cdr().header("laser", 500 * ms));
  recording_.scan("/scan", 700 * ms, {.ranges = {2.0F}});
  const auto samples = read();
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_DOUBLE_EQ(samples[1].observation.stamp, 0.7);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("a scan of /scan is left out")));
}

TEST_F(Bags, ScansMayChangeTheirNumberOfBeams) {
  drive(1.0, 0.0, 1);
  mount({});
  recording_.scan("/scan", 300 * ms, {.ranges = {2.0F}});
  recording_.scan("/scan", 500 * ms, {.ranges = {2.0F, 3.0F, 4.0F}});
  const auto samples = read();
  EXPECT_EQ(samples.at(0).observation.scan.hits.size(), 1U);
  EXPECT_EQ(samples.at(1).observation.scan.hits.size(), 3U);
}

TEST_F(Bags, CloudsAreCutAtHeightsForThePlane) {
  drive(0.0, 0.0, 1);
  mount(Pose3(Vector3{0.0, 0.0, 1.0}));
  recording_.cloud("/points", 500 * ms, "laser", {{1.0, 0.0, -1.0}, {2.0, 0.0, -0.5}, {3.0, 0.0, 2.0}});
  EXPECT_THAT(fault(), HasSubstr("has clouds, and the motion is planar: set heights"));
  params_.heights = {0.2, 1.5};
  params_.voxel_size = 0.0;
  const Scan scan = read().at(0).observation.scan;
  EXPECT_THAT(scan.hits.x, ElementsAre(2.0F));
  EXPECT_THAT(scan.hits.z, ElementsAre(0.0F));
}

TEST_F(Bags, InSpaceCloudsKeepTheirHeightsAndOdometryItsTilt) {
  recording_.transform("odom", "base_link", 0, Pose3({0.0, 0.0, 0.5}, exponential({0.1, 0.0, 0.0})));
  mount(Pose3(Vector3{0.0, 0.0, 1.0}));
  recording_.cloud("/points", 500 * ms, "laser", {{1.0, 0.0, -1.5}});
  const Observation o = read(Motion::upright).at(0).observation;
  EXPECT_NEAR(o.odom_from_robot.tilt(), 0.1, 1e-9);
  EXPECT_NEAR(o.odom_from_robot.z, 0.5, 1e-9);
  EXPECT_NEAR(o.scan.hits.z[0], -0.5, 1e-6);
  EXPECT_NEAR(o.scan.origin.z, 1.0, 1e-6);
}

TEST_F(Bags, WithoutTfTheSensorIsGiven) {
  for (const int i : {3, 7})
    recording_.odometry("/odom", 100 * ms * i, "odom", "base", Pose2{0.1 * i, 0.0, 0.0});
  recording_.scan("/scan", 500 * ms, {.ranges = {2.0F}});
  EXPECT_THAT(fault(), HasSubstr("tf does not connect laser, the frame of /scan, with base"));
  params_.sensor_from = "given";
  params_.sensor.x = 0.25;
  const Observation o = read().at(0).observation;
  EXPECT_NEAR(o.odom_from_robot.x, 0.5, 1e-9);
  EXPECT_NEAR(o.scan.hits.x[0], 2.25, 1e-6);
}

/// Share of beam ends that lie within 0.1 m of an occupied cell, from the reference poses.
double share_on_map(const BagDrive::Params& params, const OccupancyGrid& grid) {
  const DistanceField field(occupied_centres(grid), grid.resolution, 1.0F);
  BagDrive source(params, {});
  std::size_t ends = 0, near = 0;
  while (const auto sample = source.next()) {
    if (!sample->map_from_robot) continue;
    const Points placed = moved(sample->observation.scan.hits, *sample->map_from_robot);
    for (std::size_t i = 0; i < placed.size(); ++i)
      near += field.at(placed.x[i], placed.y[i]).distance <= 0.1F ? 1 : 0;
    ends += placed.size();
  }
  return static_cast<double>(near) / static_cast<double>(ends);
}

TEST(RealBags, ADriveFitsItsBuildingsPlanWithTheKnownTransformation) {
  const auto folder = dataset("bags/jarvis");
  if (folder.empty()) GTEST_SKIP() << "set GLOCAL_DATASETS to run this";
  const OccupancyGrid grid = ros_map::RosMap({file_path(folder / "i-108_10mm.yaml")}, {}).load().grid;
  BagDrive::Params params;
  params.path = file_path(folder / "jarvis_circular_path_fast.bag");
  params.scans = {"/driver_laser_navigation/laser_scan"};
  params.reference = {.topic = "/pose_ground_truth"};
  EXPECT_LT(share_on_map(params, grid), 0.1);
  params.reference = {
      .topic = "/pose_ground_truth", .x = 14.60635, .y = 3.34242, .yaw_deg = -1.53605, .time_shift = 0.135};
  // 0.86 is published for these (dynamic_robot_localization's tests), without deskewing.
  EXPECT_GT(share_on_map(params, grid), 0.85);
}

}  // namespace
}  // namespace glocal::test::bags::bag_drive_test
