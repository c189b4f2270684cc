#include "sources/carmen/carmen_writer.hpp"

#include <gtest/gtest.h>

#include "files.hpp"
#include "samples.hpp"
#include "sources/carmen/carmen_log.hpp"
#include "sources/simulation/simulation.hpp"

namespace glocal::carmen::carmen_writer_test {
namespace {

void expect_near(const Points& a, const Points& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a.x[i], b.x[i], 1e-5);
    EXPECT_NEAR(a.y[i], b.y[i], 1e-5);
  }
}

void expect_near(const Pose3& a, const Pose3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(rotation_between(a, b), 0.0, 1e-9);
}

TEST(CarmenWriter, ASimulatedDriveReadsBackAsItWas) {
  const test::TemporaryFolder folder;
  simulation::LaserDriveParams params;
  params.world =
      test::file_path(folder.write("world.yaml",
                                   "size: [20, 3]\n"
                                   "walls: [{points: [[0, 0], [20, 0], [20, 3], [0, 3]], closed: true}]\n"
                                   "free_from: [[1, 1]]\n"
                                   "way_points: [[1, 1], [6, 1], [6, 2]]\n"));
  params.laser.outliers = 0.02;
  params.laser.x = 0.2;
  params.laser.yaw_deg = 10.0;
  SourceSetup setup;
  setup.seed = 5;
  simulation::Simulation simulated(params, setup);
  LogParams log = simulation::scan_limits(params.laser);
  log.path = test::file_path(folder.write("drive.log", simulated.recording()->content));
  CarmenLog recorded(log, setup);
  const auto a = test::all_of(simulated);
  const auto b = test::all_of(recorded);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_FALSE(a[0].observation.scan.free_ends.empty());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].observation.stamp, b[i].observation.stamp);
    expect_near(a[i].observation.odom_from_robot, b[i].observation.odom_from_robot);
    expect_near(*a[i].map_from_robot, *b[i].map_from_robot);
    expect_near(a[i].observation.scan.hits, b[i].observation.scan.hits);
    expect_near(a[i].observation.scan.free_ends, b[i].observation.scan.free_ends);
  }
}

TEST(CarmenWriter, WritesTheFormatsFields) {
  CarmenScan scan;
  scan.ranges = {1.5F, 8.0F};
  scan.start_angle = -0.25;
  scan.angle_step = 0.5;
  scan.max_range = 8.0;
  scan.stamp = 2.5;
  scan.odom_from_robot = Pose2{1, 2, 0};
  scan.robot_from_laser = {0.5, 0, 0};
  EXPECT_EQ(carmen_lines(scan),
            "ROBOTLASER1 0 -0.25 0.5 0.5 8 0 0 2 1.5 8 0 1.5 2 0 1 2 0 0 0 0 0 0 2.500000 glocal 2.500000\n");
  scan.map_from_robot = Pose2{7, 8, 0};
  EXPECT_TRUE(carmen_lines(scan).starts_with("TRUEPOS 7.5 8 0 1 2 0 2.500000 glocal 2.500000\nROBOTLASER1 "));
}

}  // namespace
}  // namespace glocal::carmen::carmen_writer_test
