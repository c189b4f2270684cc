#include "sources/conversion/carmen_drive.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "files.hpp"
#include "glocal/error.hpp"
#include "sources/bags/bag_drive.hpp"
#include "sources/bags/mcap_writer.hpp"
#include "sources/carmen/carmen_log.hpp"
#include "sources/conversion/recording_drive.hpp"
#include "sources/simulation/simulation.hpp"

namespace glocal::conversion::carmen_drive_test {
namespace {

using carmen::CarmenScan;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr float infinite = std::numeric_limits<float>::infinity();

class Conversion : public testing::Test {
 protected:
  /// A simulated drive with a laser that is off the robot's centre and looks aside.
  std::filesystem::path simulated_log() {
    simulation::LaserDriveParams params;
    params.world =
        test::file_path(folder_.write("world.yaml",
                                      "size: [20, 3]\n"
                                      "walls: [{points: [[0, 0], [20, 0], [20, 3], [0, 3]], closed: true}]\n"
                                      "free_from: [[1, 1]]\n"
                                      "way_points: [[1, 1], [6, 1], [6, 2]]\n"));
    params.laser.outliers = 0.02;
    params.laser.x = 0.2;
    params.laser.yaw_deg = 10.0;
    return folder_.write("drive.log", simulation::Simulation(params, {.seed = 5}).recording()->content);
  }
  std::filesystem::path as_mcap(const std::filesystem::path& log) {
    CarmenDriveReader reader(log);
    std::string bytes;
    McapDriveWriter writer(reader.sensors(), [&](std::string_view more) { bytes += more; });
    counts_ = pass_on(reader, writer, "drive.log", warn());
    return folder_.write("drive.mcap", bytes);
  }
  std::filesystem::path as_log(const std::filesystem::path& recording, const bags::DriveTopics& choice) {
    RecordingDriveReader reader(recording, choice, bags::Damage::passed_over, warn());
    std::string text;
    CarmenDriveWriter writer(reader.sensors(), "drive.mcap", [&](std::string_view more) { text += more; });
    counts_ = pass_on(reader, writer, "drive.mcap", warn());
    return folder_.write("back.log", text);
  }
  Warn warn() {
    return [this](const std::string& text) { warnings_.push_back(text); };
  }

  test::TemporaryFolder folder_;
  DriveCounts counts_;
  std::vector<std::string> warnings_;
};

void expect_near(const Pose3& a, const Pose3& b) {
  EXPECT_NEAR(distance(a, b), 0.0, 1e-6);
  EXPECT_NEAR(rotation_between(a, b), 0.0, 1e-6);
}

void expect_near(const Points& a, const Points& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a.x[i], b.x[i], 1e-5);
    EXPECT_NEAR(a.y[i], b.y[i], 1e-5);
  }
}

TEST_F(Conversion, ALogComesBackFromMcapAsItWas) {
  const auto log = simulated_log();
  const auto before = carmen::read_carmen_log(log);
  const auto after = carmen::read_carmen_log(as_log(as_mcap(log), {.reference = "/reference"}));
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(counts_.scans, before.size());
  EXPECT_EQ(counts_.references, before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(after[i].laser, carmen::CarmenLaser::robotlaser1);
    EXPECT_EQ(after[i].ranges, before[i].ranges);
    EXPECT_EQ(after[i].stamp, before[i].stamp);
    EXPECT_EQ(after[i].max_range, before[i].max_range);
    EXPECT_NEAR(after[i].start_angle, before[i].start_angle, 1e-6);
    EXPECT_NEAR(after[i].angle_step, before[i].angle_step, 1e-8);
    expect_near(after[i].odom_from_robot, before[i].odom_from_robot);
    expect_near(after[i].robot_from_laser, before[i].robot_from_laser);
    expect_near(*after[i].map_from_robot, *before[i].map_from_robot);
  }
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(Conversion, McapGivesTheObservationsThatTheLogGives) {
  carmen::LogParams as_log;
  as_log.path = test::file_path(simulated_log());
  as_log.keyframes = {0.0, 0.0};
  as_log.max_range = 8.0;
  bags::BagDrive::Params as_bag;
  as_bag.path = test::file_path(as_mcap(as_log.path.resolved));
  as_bag.keyframes = as_log.keyframes;
  as_bag.reference.topic = "/reference";
  carmen::CarmenLog log(as_log, {});
  bags::BagDrive bag(as_bag, {.warn = warn()});
  std::size_t n = 0, free_ends = 0;
  while (const auto a = log.next()) {
    const auto b = bag.next();
    ASSERT_TRUE(b);
    EXPECT_NEAR(a->observation.stamp, b->observation.stamp, 1e-6);
    expect_near(a->observation.odom_from_robot, b->observation.odom_from_robot);
    expect_near(*a->map_from_robot, *b->map_from_robot);
    expect_near(a->observation.scan.hits, b->observation.scan.hits);
    expect_near(a->observation.scan.free_ends, b->observation.scan.free_ends);
    free_ends += b->observation.scan.free_ends.size();
    ++n;
  }
  EXPECT_GT(n, 10U);
  EXPECT_GT(free_ends, 10U);
  EXPECT_FALSE(bag.next());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(Conversion, ReadingsThatMetNothingAreInfinite) {
  CarmenScan scan;
  scan.ranges = {1.5F, 0.0F, 79.5F, 81.83F, -1.0F, infinite, std::nanf("")};
  scan.start_angle = -0.5;
  scan.angle_step = 0.25;
  scan.stamp = 3.25;
  const bags::LaserScan out = laser_scan(scan, 80.0, "laser");
  EXPECT_THAT(out.ranges, ElementsAre(1.5F, 0.0F, 79.5F, infinite, infinite, infinite, infinite));
  EXPECT_EQ(out.range_max, 80.0F);
  EXPECT_EQ(out.header.stamp_ns, 3'250'000'000);
  EXPECT_EQ(out.angle_min, -0.5F);
  EXPECT_EQ(out.angle_max, 1.0F);
  EXPECT_EQ(out.angle_increment, 0.25F);
  scan.max_range = 50.0;
  EXPECT_EQ(laser_scan(scan, 80.0, "laser").range_max, 50.0F) << "what the log says";
}

const DriveSensor front{"/front", "laser", false, {}};

/// A laser of a robot at the origin.
DriveScan drive_scan(const Pose3& robot_from_sensor) {
  bags::LaserScan laser;
  laser.header = {5'000'000'000, "laser"};
  laser.angle_min = 0.0F;
  laser.angle_increment = 0.5F;
  laser.range_min = 0.25F;
  laser.range_max = 10.0F;
  laser.ranges = {1.0F, infinite, 0.125F, std::nanf(""), 12.0F};
  DriveScan scan;
  scan.stamp_ns = 5'000'000'000;
  scan.robot_from_sensor = robot_from_sensor;
  scan.rays = laser;
  return scan;
}

TEST_F(Conversion, LogsHaveTheLargestRangeWhereNothingWasMet) {
  const CarmenScan scan = carmen_scan(drive_scan({}), front, "a.bag");
  EXPECT_THAT(scan.ranges, ElementsAre(1.0F, 10.0F, 0.0F, 0.0F, 10.0F));
  EXPECT_EQ(scan.max_range, 10.0);
  EXPECT_EQ(scan.stamp, 5.0);
}

TEST_F(Conversion, LogsHaveTheRangeOfASickWhereADriverSaysNone) {
  for (const float range_max : {0.0F, -1.0F, infinite, std::nanf("")}) {
    DriveScan scan = drive_scan({});
    std::get<bags::LaserScan>(scan.rays).range_max = range_max;
    const CarmenScan out = carmen_scan(scan, front, "a.bag");
    EXPECT_EQ(out.max_range, 80.0) << range_max;
    EXPECT_THAT(out.ranges, ElementsAre(1.0F, 80.0F, 0.0F, 0.0F, 12.0F)) << range_max;
  }
}

TEST_F(Conversion, ScansWithoutReadingsSayNothingInALog) {
  DriveScan scan = drive_scan({{0.3, 0.0, 0.2}, {0.0, 1.0, 0.0, 0.0}});
  std::get<bags::LaserScan>(scan.rays).ranges.clear();
  std::string text;
  CarmenDriveWriter writer({front}, "a.bag", [&](std::string_view more) { text += more; });
  writer.write(scan);
  writer.finish();
  const auto scans = carmen::read_carmen_log(folder_.write("empty.log", text));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].stamp, 5.0);
  EXPECT_NEAR(scans[0].robot_from_laser.x, 0.3, 1e-9);
  const Scan rays = carmen::robot_scan(scans[0], {});
  EXPECT_EQ(rays.hits.size() + rays.free_ends.size(), 0U);
}

TEST_F(Conversion, ALaserUpsideDownIsTurnedOver) {
  // Rolled over: what it sees on its left is on the robot's right.
  const CarmenScan scan = carmen_scan(drive_scan({{0.3, 0.0, 0.2}, {0.0, 1.0, 0.0, 0.0}}), front, "a.bag");
  EXPECT_THAT(scan.ranges, ElementsAre(10.0F, 0.0F, 0.0F, 10.0F, 1.0F));
  EXPECT_NEAR(scan.start_angle, -2.0, 1e-6);
  EXPECT_NEAR(scan.angle_step, 0.5, 1e-6);
  EXPECT_NEAR(scan.robot_from_laser.x, 0.3, 1e-9);
  EXPECT_NEAR(scan.robot_from_laser.theta, 0.0, 1e-9);
}

TEST_F(Conversion, ScansAgainstTheClockAreTurnedRound) {
  DriveScan scan = drive_scan({});
  std::get<bags::LaserScan>(scan.rays).angle_increment = -0.5F;
  const CarmenScan out = carmen_scan(scan, front, "a.bag");
  EXPECT_NEAR(out.start_angle, -2.0, 1e-6);
  EXPECT_NEAR(out.angle_step, 0.5, 1e-6);
  EXPECT_EQ(out.ranges.back(), 1.0F);
}

TEST_F(Conversion, LogsHaveLevelLasersOnly) {
  const auto fault = [&](const DriveScan& scan) {
    return test::config_error(folder_.path(), [&] { static_cast<void>(carmen_scan(scan, front, "a.bag")); });
  };
  EXPECT_EQ(fault(drive_scan(Pose3(exponential({0.0, radians(20.0), 0.0})))),
            "a.bag: error: the sensor of /front is tilted by 20.0 deg, and lasers of a CARMEN log are level; "
            "convert to MCAP, or choose another topic with --scans");
  EXPECT_EQ(fault(drive_scan(Pose3(exponential({radians(0.5), 0.0, 0.0})))), "");
  DriveScan cloud = drive_scan({});
  cloud.rays = bags::PointCloud{};
  EXPECT_THAT(fault(cloud),
              HasSubstr("clouds, which cannot be written as a CARMEN log: it has planar scans"));
  DriveScan more = drive_scan({});
  std::get<bags::LaserScan>(more.rays).angle_increment = 2.0F;
  EXPECT_THAT(fault(more),
              HasSubstr("a scan has 5 readings over 458.4 deg; a CARMEN log has some, within a"));
}

TEST_F(Conversion, FrontAndRearLasersHaveTopicsOfTheirOwn) {
  const auto log = folder_.write("two.log",
                                 "FLASER 2 1 2 0.1 0 0 0 0 0 1.5 host 1.5\n"
                                 "RLASER 2 3 4 -0.1 0 3.141592 0 0 0 1.5 host 1.5\n"
                                 "ROBOTLASER1 0 0 1 1 8 0 0 2 1 2 0 0 0 0 0 0 0 0 0 0 0 0 1.5 host 1.5\n"
                                 "FLASER 2 1 2 1.1 0 0 1 0 0 2.5 host 2.5\n"
                                 "FLASER 2 1 2 1.1 0 0 1 0 0 2.5 host 2.5\n");
  bags::Recording recording(as_mcap(log));
  EXPECT_EQ(counts_.scans, 3U);
  EXPECT_THAT(warnings_, ElementsAre("drive.log: 1 scans are left out, as their stamps stand still or run "
                                     "backwards"));
  std::map<std::string, int> messages;
  while (const auto message = recording.next()) ++messages[message->connection->topic];
  EXPECT_THAT(messages, ElementsAre(testing::Pair("/scan", 2), testing::Pair("/scan_rear", 1),
                                    testing::Pair("/tf", 3), testing::Pair("/tf_static", 1)));
}

TEST_F(Conversion, ALaserThatMovesHasItsPoseWithEachScan) {
  const auto log = folder_.write("moving.log",
                                 "FLASER 2 1 2 0.1 0 0.5 0 0 0 1.5 host 1.5\n"
                                 "FLASER 2 1 2 0.1 0 0.75 0 0 0 2.5 host 2.5\n");
  EXPECT_FALSE(CarmenDriveReader(log).sensors()[0].robot_from_sensor);
  const auto back = carmen::read_carmen_log(as_log(as_mcap(log), {}));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_NEAR(back[0].robot_from_laser.theta, 0.5, 1e-6);
  EXPECT_NEAR(back[1].robot_from_laser.theta, 0.75, 1e-6);
}

TEST_F(Conversion, StampsThatOtherFormatsDoNotHaveAreAFault) {
  const auto log = folder_.write("old.log", "FLASER 2 1 2 0 0 0 0 0 0 -1.5 host 1.5\n");
  EXPECT_EQ(
      test::config_error(folder_.path(), [&] { CarmenDriveReader{log}; }),
      "old.log:1: error: the time stamp -1.5 is not of the years 1970 to 2037, which other formats have; "
      "correct it");
}

}  // namespace
}  // namespace glocal::conversion::carmen_drive_test
