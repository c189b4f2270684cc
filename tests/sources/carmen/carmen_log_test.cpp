#include "sources/carmen/carmen_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "files.hpp"
#include "samples.hpp"

namespace glocal::carmen::carmen_log_test {
namespace {

using testing::ElementsAre;

/// A FLASER line of a robot on the x axis with its laser at its centre.
std::string flaser(double x, double theta = 0.0, double stamp = 0.0, const std::string& readings = "2 1 1") {
  const std::string pose = std::to_string(x) + " 0 " + std::to_string(theta) + " ";
  return "FLASER " + readings + " " + pose + pose + std::to_string(stamp) + " h 0\n";
}

/// A drive along x in steps of 0.1 m, stamped with the number of the scan.
std::string straight_drive(int scans) {
  std::string log;
  for (int i = 0; i < scans; ++i) log += flaser(0.1 * i, 0.0, i);
  return log;
}

LogParams params_for(const std::filesystem::path& file) {
  LogParams params;
  params.path = test::file_path(file);
  return params;
}

std::vector<Sample> read_all(const LogParams& params, const SourceSetup& setup = {}) {
  CarmenLog log(params, setup);
  return test::all_of(log);
}

std::vector<double> stamps(const std::vector<Sample>& samples) {
  std::vector<double> out;
  for (const Sample& sample : samples) out.push_back(sample.observation.stamp);
  return out;
}

TEST(CarmenLog, TakesKeyframesByDistance) {
  const test::TemporaryFolder folder;
  LogParams params = params_for(folder.write("a.log", straight_drive(11)));
  EXPECT_THAT(stamps(read_all(params)), ElementsAre(0, 3, 6, 9));
  params.keyframes.distance = 0.0;
  EXPECT_EQ(read_all(params).size(), 11U);
}

TEST(CarmenLog, TakesKeyframesByAngle) {
  const test::TemporaryFolder folder;
  std::string log;
  for (int i = 0; i < 8; ++i) log += flaser(0.0, 3.0 + 0.15 * i, i);  // Across pi.
  EXPECT_THAT(stamps(read_all(params_for(folder.write("a.log", log)))), ElementsAre(0, 2, 4, 6));
}

TEST(CarmenLog, TakesSegmentsByShareOfThePath) {
  const test::TemporaryFolder folder;
  LogParams params = params_for(folder.write("a.log", straight_drive(11)));
  params.keyframes.distance = 0.0;
  params.segments = {{0.05, 0.25}, {0.75, 1.0}};
  const auto samples = read_all(params);
  EXPECT_THAT(stamps(samples), ElementsAre(1, 2, 8, 9, 10));
  std::vector<int> segments;
  for (const Sample& sample : samples) segments.push_back(sample.segment);
  EXPECT_THAT(segments, ElementsAre(0, 0, 1, 1, 1));
}

TEST(CarmenLog, MeasuresThePathByOdometry) {
  const test::TemporaryFolder folder;
  std::string log;
  for (const int x : {0, 1, 2, 5, 8}) {
    // The reference poses jump back and forth, as corrected ones may.
    log += "TRUEPOS " + std::to_string(x % 2) + " 0 0 0 0 0 0 h 0\n" + flaser(x, 0.0, x);
  }
  LogParams params = params_for(folder.write("a.log", log));
  EXPECT_THAT(path_lengths(read_carmen_log(params.path.resolved)), ElementsAre(0, 1, 2, 5, 8));
  params.segments = {{0.0, 0.5}};
  EXPECT_THAT(stamps(read_all(params)), ElementsAre(0, 1, 2));
}

TEST(CarmenLog, TellsHitsFromRaysThatMetNothing) {
  const test::TemporaryFolder folder;
  // 8 readings from -90 degrees in steps of 22.5; the fifth looks straight ahead.
  const std::string log = flaser(0, 0, 0, "8 1 0.05 -1 inf 2 nan 30 19.99");
  LogParams params = params_for(folder.write("a.log", log));
  const Scan scan = read_all(params).front().observation.scan;
  ASSERT_EQ(scan.hits.size(), 3U);
  EXPECT_NEAR(scan.hits[0].x, 0.0, 1e-6);
  EXPECT_NEAR(scan.hits[0].y, -1.0, 1e-6);
  EXPECT_NEAR(scan.hits[1].x, 2.0, 1e-6);
  EXPECT_NEAR(scan.hits[1].y, 0.0, 1e-6);
  EXPECT_NEAR(std::hypot(scan.hits[2].x, scan.hits[2].y), 19.99, 1e-5);
  ASSERT_EQ(scan.free_ends.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::hypot(scan.free_ends[i].x, scan.free_ends[i].y), 8.0, 1e-5);
  }
  EXPECT_NEAR(std::atan2(scan.free_ends[0].y, scan.free_ends[0].x), radians(-45.0), 1e-6);

  params.free_range = 0.0;
  EXPECT_TRUE(read_all(params).front().observation.scan.free_ends.empty());
  params.free_range = 100.0;
  params.max_range = 1.5;
  const Scan near = read_all(params).front().observation.scan;
  EXPECT_EQ(near.hits.size(), 1U);
  ASSERT_EQ(near.free_ends.size(), 6U);
  EXPECT_NEAR(std::hypot(near.free_ends[5].x, near.free_ends[5].y), 1.5, 1e-6)
      << "never trusted beyond max_range";
}

TEST(CarmenLog, AReadingAtTheLimitMetNothingHoweverTheLimitIsRounded) {
  for (const double limit : {8.18, 8.19}) {
    carmen::CarmenScan reading;
    reading.max_range = 81.9;
    reading.ranges = {static_cast<float>(limit)};
    carmen::LogParams params;
    params.max_range = limit;
    params.free_range = limit;
    const Scan scan = carmen::robot_scan(reading, params);
    EXPECT_EQ(scan.hits.size(), 0U) << limit;
    EXPECT_EQ(scan.free_ends.size(), 1U) << limit;
  }
}

TEST(CarmenLog, PlacesTheLaserOnTheRobotAndCorrectsItsYaw) {
  const test::TemporaryFolder folder;
  // The laser is 0.5 m ahead of the robot, which heads along odometry's y.
  const double half_pi = std::acos(0.0);
  const std::string log =
      "FLASER 2 1 3 1 2.5 " + std::to_string(half_pi) + " 1 2 " + std::to_string(half_pi) + " 0 h 0\n";
  LogParams params = params_for(folder.write("a.log", log));
  Scan scan = read_all(params).front().observation.scan;
  EXPECT_NEAR(scan.origin.x, 0.5, 1e-6);
  EXPECT_NEAR(scan.hits[0].x, 0.5, 1e-6);
  EXPECT_NEAR(scan.hits[0].y, -1.0, 1e-6);
  EXPECT_NEAR(scan.hits[1].x, 3.5, 1e-6);
  EXPECT_NEAR(scan.hits[1].y, 0.0, 1e-6);
  params.laser_yaw_deg = 90.0;
  scan = read_all(params).front().observation.scan;
  EXPECT_NEAR(scan.hits[0].x, 1.5, 1e-6);
  EXPECT_NEAR(scan.hits[0].y, 0.0, 1e-6);
}

TEST(CarmenLog, ChoosesTheLaser) {
  const test::TemporaryFolder folder;
  LogParams params =
      params_for(folder.write("a.log", flaser(0, 0, 1) + "RLASER 2 1 1 0 0 0 0 0 0 2 h 0\n" +
                                           "ROBOTLASER1 0 0 1 1 30 0 0 1 1 0 0 0 0 0 0 0 0 0 0 0 0 3 h 0\n"));
  params.keyframes.distance = 0.0;
  EXPECT_THAT(stamps(read_all(params)), ElementsAre(1));
  params.laser = "rear";
  EXPECT_THAT(stamps(read_all(params)), ElementsAre(2));
  params.path = test::file_path(folder.write("b.log", flaser(0)));
  EXPECT_EQ(test::config_error(params.path.resolved.parent_path(), [&] { read_all(params); }),
            "b.log: error: has no scan of the rear laser; set laser to front");
}

TEST(CarmenLog, RobotlaserKnowsItsOwnRange) {
  const test::TemporaryFolder folder;
  const LogParams params =
      params_for(folder.write("a.log", "ROBOTLASER1 0 0 1 1 5 0 0 2 4.9 5 0 0 0 0 0 0 0 0 0 0 0 0 3 h 0\n"));
  const Scan scan = read_all(params).front().observation.scan;
  EXPECT_EQ(scan.hits.size(), 1U);
  ASSERT_EQ(scan.free_ends.size(), 1U);
  EXPECT_NEAR(std::hypot(scan.free_ends[0].x, scan.free_ends[0].y), 5.0, 1e-6);
}

TEST(CarmenLog, WarnsOnceOfTimeThatDoesNotRunForwards) {
  const test::TemporaryFolder folder;
  LogParams params = params_for(
      folder.write("a.log", flaser(0, 0, 5) + flaser(1, 0, 4) + flaser(2, 0, 4) + flaser(3, 0, 6)));
  std::vector<std::string> warnings;
  SourceSetup setup;
  setup.warn = [&](const std::string& warning) { warnings.push_back(warning); };
  EXPECT_THAT(stamps(read_all(params, setup)), ElementsAre(5, 4, 4, 6));
  EXPECT_THAT(warnings,
              ElementsAre(params.path.text +
                          ": 2 of 4 time stamps stand still or run backwards; scans are used in file order"));
  warnings.clear();
  params.path = test::file_path(folder.write("b.log", straight_drive(3)));
  read_all(params, setup);
  EXPECT_TRUE(warnings.empty());
}

TEST(CarmenLog, RefusesSegmentsWithoutScans) {
  const test::TemporaryFolder folder;
  LogParams params = params_for(folder.write("a.log", straight_drive(3)));
  params.segments = {{0.0, 0.1}, {0.2, 0.3}, {0.6, 0.75}};
  EXPECT_EQ(test::config_error(params.path.resolved.parent_path(), [&] { read_all(params); }),
            "a.log: error: has no scan between 0.2 and 0.3 of its path; widen the segment\n"
            "a.log: error: has no scan between 0.6 and 0.75 of its path; widen the segment");
}

struct LogFacts {
  const char* file;
  std::size_t scans;
  std::size_t beams;
  double path;  ///< m
};

class SharedLog : public testing::TestWithParam<LogFacts> {};

TEST_P(SharedLog, IsWhatItsDescriptionSays) {
  const auto file = test::dataset(GetParam().file);
  if (file.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const auto scans = read_carmen_log(file);
  EXPECT_EQ(scans.size(), GetParam().scans);
  EXPECT_EQ(scans.front().ranges.size(), GetParam().beams);
  EXPECT_NEAR(path_lengths(scans).back(), GetParam().path, 1.0);
  EXPECT_TRUE(scans.back().map_from_robot);
}

INSTANTIATE_TEST_SUITE_P(Datasets, SharedLog,
                         testing::Values(LogFacts{"intel/intel.log.xz", 13631, 180, 508.0},
                                         LogFacts{"fr079/fr079.log.xz", 4934, 360, 392.0},
                                         LogFacts{"mit_csail/mit_csail.log.xz", 1988, 361, 374.0},
                                         LogFacts{"seattle/seattle.log.xz", 241, 361, 190.0},
                                         LogFacts{"fhw/fhw.log.xz", 488, 180, 398.3}),
                         [](const auto& log) {
                           const std::string name = log.param.file;
                           return name.substr(0, name.find('/'));
                         });

}  // namespace
}  // namespace glocal::carmen::carmen_log_test
