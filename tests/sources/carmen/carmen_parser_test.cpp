#include "sources/carmen/carmen_parser.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "files.hpp"

namespace glocal::carmen::carmen_parser_test {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<CarmenScan> parse(std::string_view content) {
  const test::TemporaryFolder folder;
  return read_carmen_log(folder.write("a.log", content));
}

std::string fault_of(std::string_view content) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("a.log", content);
  return test::config_error(file.parent_path(), [&] { static_cast<void>(read_carmen_log(file)); });
}

TEST(CarmenParser, ReadsFlaserWithReferencePoseOfTheLaser) {
  const auto scans = parse(
      "# a comment\n"
      "PARAM robot_width 0.5 nohost 0\n"
      "ODOM 1 2 0.5 0 0 0 9.5 host 0\n"
      "TRUEPOS 5 6 1.5707963267948966 1 2 0 10 host 0\r\n"
      "FLASER 4 1.5 81.83 -1 0.25 1.5 2 0 1 2 0 10.25 host 0\r\n"
      "FLASER 4 1 2 3 nan 2 2 0 1.5 2 0 10.5 host 0\n");
  ASSERT_EQ(scans.size(), 2U);
  const CarmenScan& scan = scans[0];
  EXPECT_EQ(scan.line, 5);
  EXPECT_EQ(scan.laser, CarmenLaser::flaser);
  EXPECT_EQ(scan.ranges, (std::vector<float>{1.5F, 81.83F, -1.0F, 0.25F}));
  EXPECT_DOUBLE_EQ(scan.stamp, 10.25);
  EXPECT_EQ(scan.odom_from_robot, (Pose2{1, 2, 0}));
  // The laser sits half a metre ahead of the robot; it looks along the map's y, so the robot stands 0.5 m
  // below it.
  EXPECT_NEAR(scan.robot_from_laser.x, 0.5, 1e-12);
  ASSERT_TRUE(scan.map_from_robot);
  EXPECT_NEAR(scan.map_from_robot->x, 5.0, 1e-12);
  EXPECT_NEAR(scan.map_from_robot->y, 5.5, 1e-12);
  EXPECT_NEAR(scan.map_from_robot->theta, pi / 2, 1e-12);
  EXPECT_FALSE(scans[1].map_from_robot) << "a reference pose belongs to one scan only";
  EXPECT_TRUE(std::isnan(scans[1].ranges[3]));
}

TEST(CarmenParser, GivesFlaserBeamsTheAnglesOfASickLaser) {
  const auto angles = [](int n) {
    std::string line = "FLASER " + std::to_string(n);
    for (int i = 0; i < n; ++i) line += " 1";
    const CarmenScan scan = parse(line + " 0 0 0 0 0 0 1 h 0\n").front();
    return std::pair(degrees(scan.start_angle), degrees(scan.angle_step));
  };
  for (const auto& [readings, step] : {std::pair(180, 1.0), {181, 1.0}, {360, 0.5}, {361, 0.5}}) {
    EXPECT_NEAR(angles(readings).first, -90.0, 1e-12);
    EXPECT_NEAR(angles(readings).second, step, 1e-12) << readings;
  }
}

TEST(CarmenParser, TurnsTheRearLaserBackwards) {
  const auto scans = parse(
      "TRUEPOS 3 4 0 0 0 0 1 h 0\n"
      "RLASER 2 1 1 -0.5 0 0 0 0 0 1 h 0\n"
      "RLASER 2 1 1 -0.5 0 3.14159265358979 0 0 0 1 h 0\n");
  ASSERT_EQ(scans.size(), 2U);
  for (const CarmenScan& scan : scans) {
    EXPECT_NEAR(scan.robot_from_laser.x, -0.5, 1e-12);
    EXPECT_NEAR(std::abs(scan.robot_from_laser.theta), pi, 1e-9);
  }
  EXPECT_NEAR(scans[0].map_from_robot->x, 3.5, 1e-12);
  EXPECT_NEAR(scans[0].map_from_robot->theta, 0.0, 1e-12);
}

TEST(CarmenParser, ReadsRobotlaserWithItsOwnGeometry) {
  const auto scans = parse(
      "ROBOTLASER1 0 -1.0 2.0 0.5 30.5 0.01 0 3 1 2 3 2 100 200 0.1 0 0 0 0 0 0.4 0.1 0.5 0.5 1e9 12.5 h "
      "0\n");
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].laser, CarmenLaser::robotlaser1);
  EXPECT_DOUBLE_EQ(scans[0].start_angle, -1.0);
  EXPECT_DOUBLE_EQ(scans[0].angle_step, 0.5);
  EXPECT_DOUBLE_EQ(scans[0].max_range, 30.5);
  EXPECT_DOUBLE_EQ(scans[0].stamp, 12.5);
  EXPECT_DOUBLE_EQ(scans[0].robot_from_laser.x, 0.1);
  EXPECT_EQ(scans[0].ranges, (std::vector<float>{1, 2, 3}));
}

TEST(CarmenParser, ALogMayEndWithoutNewline) {
  EXPECT_EQ(parse("FLASER 2 1 1 0 0 0 0 0 0 1 h 0").size(), 1U);
}

TEST(CarmenParser, AByteOrderMarkIsNoPartOfTheFirstLine) {
  EXPECT_EQ(parse("\xEF\xBB\xBF"
                  "FLASER 2 1 1 0 0 0 0 0 0 1 h 0\n")
                .size(),
            1U);
}

constexpr const char* again = "; delete the line or get a fresh copy of the log";

TEST(CarmenParser, NamesLineAndRuleOfEveryFault) {
  EXPECT_EQ(fault_of("FLASER 3 1 1 0 0 0 0 0 0 1 h 0\n"
                     "FLASER 2 1 1 0 0 0 0 0 0 1 h 0\n"
                     "FLASER 2 1 1 1 0 0 0 0 0 0 1 h 0\n"
                     "FLASER 2 1 1,5 0 0 0 0 0 0 1 h 0\n"
                     "FLASER 2 1 1 0 0 nan 0 0 0 1 h 0\n"
                     "ODOM 0 0 x 0 0 0 1 h 0\n"
                     "TRUEPOS 0 0 0 0 1 h 0\n"
                     "FLASER\n"),
            std::string("a.log:1: error: FLASER says 3 readings but has room for 2 (13 fields, 14 needed)") +
                again + "\na.log:3: error: FLASER says 2 readings but has room for 3 (14 fields, 13 needed)" +
                again + "\na.log:4: error: FLASER reading: '1,5' is not a number" + again +
                "\na.log:5: error: FLASER laser pose: must be a finite number" + again +
                "\na.log:6: error: ODOM odometry pose: 'x' is not a number" + again +
                "\na.log:7: error: TRUEPOS has 8 fields where 10 are needed" + again +
                "\na.log:8: error: FLASER ends before number of readings" + again);
}

TEST(CarmenParser, RefusesPosesThatAreNowhere) {
  for (const char* far : {"1e300", "-1.1e7"}) {
    EXPECT_THAT(fault_of(fmt::format("ODOM 0 {} 0 0 0 0 1 h 0\n", far)),
                testing::AllOf(testing::StartsWith("a.log:1: error: ODOM odometry pose: "),
                               testing::HasSubstr("m is too far, at most 10000000 m are allowed")));
  }
}

TEST(CarmenParser, RefusesAbsurdCounts) {
  for (const char* count : {"-5", "0", "1", "100001", "4000000000000"}) {
    EXPECT_EQ(fault_of(std::string("FLASER ") + count + " 1 1 0 0 0 0 0 0 1 h 0\n"),
              std::string("a.log:1: error: FLASER number of readings: ") + count +
                  " is out of range, must be 2 to 100000" + again);
  }
  EXPECT_EQ(fault_of("ROBOTLASER1 0 -1 2 0 30 0.01 0 1 1 0 0 0 0 0 0 0 0 0 0 0 0 1 h 0\n"),
            std::string("a.log:1: error: ROBOTLASER1 angular resolution: must be above 0 rad and keep all "
                        "readings within a full turn") +
                again);
}

TEST(CarmenParser, SaysWhereALogIsCutOff) {
  EXPECT_EQ(fault_of("FLASER 2 1 1 0 0 0 0 0 0 1 h 0\nFLASER 2 1 1 0 0"),
            "a.log:2: error: FLASER says 2 readings but has room for 0 (6 fields, 13 needed); the log is cut "
            "off here: delete this line or get a fresh copy");
}

TEST(CarmenParser, StopsAfterTwentyFaults) {
  std::string log;
  for (int i = 0; i < 50; ++i) log += "FLASER 2 1\n";
  const std::string message = fault_of(log);
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 19);
}

TEST(CarmenParser, RefusesFilesWithoutScans) {
  EXPECT_EQ(fault_of(""), "a.log: error: is empty; a CARMEN log with laser scans is needed");
  EXPECT_EQ(fault_of("\n \n"), "a.log: error: is empty; a CARMEN log with laser scans is needed");
  EXPECT_EQ(fault_of("ODOM 0 0 0 0 0 0 1 h 0\n"),
            "a.log: error: has no FLASER, RLASER or ROBOTLASER1 line; is this a CARMEN log?");
}

TEST(CarmenParser, ALineThatIsNoneIsRefused) {
  const std::string good = "PARAM a b\n";
  std::string long_line = good + "FLASER ";
  long_line.resize(long_line.size() + 10'000'000, '1');
  EXPECT_EQ(
      fault_of(long_line),
      "a.log:2: error: the line has 10000007 bytes, at most 10000000 are allowed; is this a CARMEN log?");
  const std::string odd = "FLASER 2 1 " + std::string(100, '\x01') + " 0 0 0 0 0 0 1 h 1\n";
  EXPECT_NE(fault_of(odd).find("'\\u0001\\u0001"), std::string::npos);
  EXPECT_LT(fault_of(odd).size(), 300U);
}

}  // namespace
}  // namespace glocal::carmen::carmen_parser_test
