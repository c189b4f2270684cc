#include "sources/simulation/lidar_simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"
#include "glocal/catalog.hpp"
#include "glocal/yaml.hpp"
#include "octree_files.hpp"
#include "samples.hpp"
#include "sources/simulation/lidar.hpp"
#include "sources/simulation/scene.hpp"
#include "sources/simulation/simulation.hpp"

namespace glocal::simulation::lidar_simulation_test {
namespace {

using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

/// A room of 6 m x 4 m x 2.5 m with a drive along x, then along y.
constexpr const char* room =
    "size: [6, 4]\n"
    "ceiling: 2.5\n"
    "walls:\n"
    "  - {points: [[0, 0], [6, 0], [6, 4], [0, 4]], closed: true}\n"
    "free_from: [[1, 1]]\n"
    "way_points: [[1, 1], [3, 1], [3, 3]]\n";

class LidarDrive : public testing::Test {
 protected:
  LidarDrive() { set_world(room); }

  void set_world(const std::string& yaml) {
    params_.world = test::file_path(folder_.write("world.yaml", yaml));
  }

  [[nodiscard]] std::vector<Sample> read_all(std::uint64_t seed = 1) const {
    LidarSimulation source(params_, {.seed = seed});
    return test::all_of(source);
  }

  /// What is wrong with a drive's parameters or world; empty if nothing is.
  [[nodiscard]] std::string fault(const std::string& yaml) const {
    return test::config_error(folder_ / "", [&] {
      ParamsOf<LidarDriveParams> params;
      read_yaml(folder_.write("params.yaml", "world: world.yaml\n" + yaml), params);
      const LidarSimulation made(params.value, {});
    });
  }

  /// A lidar that measures without any fault, and does not sway.
  static LidarParams exact(int beams, double lowest, double highest, double step_deg) {
    LidarParams lidar;
    lidar.beams = beams;
    lidar.vertical_fov_deg = {lowest, highest};
    lidar.azimuth_step_deg = step_deg;
    lidar.min_range = 0.0;
    lidar.noise = lidar.outliers = lidar.dropped = 0.0;
    lidar.tilt_deg = lidar.tilt_noise_deg = 0.0;
    return lidar;
  }

  test::TemporaryFolder folder_;
  LidarDriveParams params_;
};

/// How far a place is from the nearest of the room's six faces, m.
double off_the_room(const Vector3& p) {
  return std::min({std::abs(p.x()), std::abs(p.x() - 6.0), std::abs(p.y()), std::abs(p.y() - 4.0),
                   std::abs(p.z()), std::abs(p.z() - 2.5)});
}

Vector3 hit(const Scan& scan, std::size_t i) {
  return {scan.hits.x[i], scan.hits.y[i], scan.hits.z[i]};
}

TEST_F(LidarDrive, MeetsWallsFloorAndCeiling) {
  params_.lidar = exact(3, -45.0, 45.0, 90.0);
  const Sample sample = read_all()[0];
  // From (1, 1, 1), looking along x: behind 1 m, to the right 1 m, ahead 5 m, to the left 3 m. At 45 degrees
  // the floor is 1 m below and 1 m away, the ceiling 1.5 m above.
  const Pose3 expected(Vector3{1.0, 1.0, 1.0});
  EXPECT_EQ(sample.map_from_robot, expected);
  const Scan& scan = sample.observation.scan;
  ASSERT_EQ(scan.hits.size(), 12U);
  const std::vector<Vector3> hits{{-1, 0, -1},   {-1, 0, 0}, {-1, 0, 1}, {0, -1, -1},
                                  {0, -1, 0},    {0, -1, 1}, {1, 0, -1}, {5, 0, 0},
                                  {1.5, 0, 1.5}, {0, 1, -1}, {0, 3, 0},  {0, 1.5, 1.5}};
  for (std::size_t i = 0; i < hits.size(); ++i)
    EXPECT_NEAR((hit(scan, i) - hits[i]).norm(), 0.0, 1e-5) << "ray " << i;
  EXPECT_EQ(scan.origin, Point{});
  EXPECT_TRUE(scan.times.empty());
  EXPECT_TRUE(scan.free_ends.empty());
}

TEST_F(LidarDrive, SeesOverLowThings) {
  set_world(std::string(room) +
            "rectangles: [{centre: [3.8, 1], size: [1, 1], height: 0.5, on_map: false}]\n"
            "circles: [{centre: [1, 3], radius: 0.5, height: 0.8}]\n");
  params_.lidar = exact(2, -10.0, 0.0, 90.0);
  const Scan scan = read_all()[0].observation.scan;
  // A ray 10 degrees down is 0.59 m high over the near side of the box, 2.3 m away, and 0.42 m over its far
  // side; at the side of the round thing, 1.5 m away, it is 0.74 m high.
  ASSERT_EQ(scan.hits.size(), 8U);
  const double slope = std::tan(radians(10.0));
  EXPECT_NEAR(scan.hits.z[4], -0.5, 1e-5) << "the top of the box";
  EXPECT_NEAR(scan.hits.x[4], 0.5 / slope, 1e-5);
  EXPECT_NEAR(scan.hits.x[5], 5.0, 1e-5) << "the wall behind it";
  EXPECT_NEAR(scan.hits.y[6], 1.5, 1e-5) << "the side of the round thing";
  EXPECT_NEAR(scan.hits.z[6], -1.5 * slope, 1e-5);
  EXPECT_NEAR(scan.hits.y[7], 3.0, 1e-5) << "the wall behind it";
}

TEST_F(LidarDrive, SwaysWithinItsTiltAndKnowsWhereItIs) {
  params_.lidar = exact(8, -30.0, 30.0, 10.0);
  params_.lidar.tilt_deg = 5.0;
  params_.step_length = 0.1;
  const auto samples = read_all();
  double most = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Pose3& pose = *samples[i].map_from_robot;
    most = std::max(most, pose.tilt());
    EXPECT_LT(pose.tilt(), radians(5.0 * std::sqrt(2.0)));
    if (i > 0) {
      EXPECT_LT(std::abs(pose.tilt() - samples[i - 1].map_from_robot->tilt()), radians(3.0)) << "smoothly";
    }
    const Scan& scan = samples[i].observation.scan;
    ASSERT_EQ(scan.hits.size(), 8U * 36U);
    for (std::size_t k = 0; k < scan.hits.size(); ++k)
      ASSERT_LT(off_the_room(pose * hit(scan, k)), 1e-5) << "observation " << i;
    EXPECT_NEAR(samples[i].observation.odom_from_robot.tilt(), pose.tilt(), 1e-9);
  }
  EXPECT_GT(most, radians(1.0));
}

TEST_F(LidarDrive, PointsOfAMovingRobotAreMeasuredFromWhereItIsThen) {
  params_.lidar = exact(4, -20.0, 20.0, 5.0);
  params_.lidar.tilt_deg = 3.0;
  params_.lidar.scan_time = 0.5;
  params_.step_length = 0.5;
  const auto samples = read_all();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Scan& scan = samples[i].observation.scan;
    ASSERT_EQ(scan.times.size(), scan.hits.size());
    EXPECT_TRUE(std::is_sorted(scan.times.begin(), scan.times.end()));
    EXPECT_NEAR(scan.times.front(), -0.5, 0.01);
    EXPECT_EQ(scan.times.back(), 0.0F);
    double most = 0.0;
    for (std::size_t k = 0; k < scan.hits.size(); ++k)
      most = std::max(most, off_the_room(*samples[i].map_from_robot * hit(scan, k)));
    EXPECT_GT(most, 0.1) << "seen from the last pose, observation " << i;
    EXPECT_LT(off_the_room(*samples[i].map_from_robot * hit(scan, scan.hits.size() - 1)), 1e-5);
  }
  // The first scan is made at rest but for the swaying.
  for (std::size_t k = 0; k < samples[0].observation.scan.hits.size(); ++k)
    EXPECT_LT(off_the_room(*samples[0].map_from_robot * hit(samples[0].observation.scan, k)), 0.3);
}

TEST_F(LidarDrive, HasNoiseOutliersAndGaps) {
  params_.lidar = exact(16, -10.0, 10.0, 1.0);
  params_.lidar.noise = 0.03;
  params_.lidar.dropped = 0.1;
  double squares = 0.0;
  double n = 0.0;
  double rays = 0.0;
  double outliers = 0.0;
  Scene scene(read_world(params_.world.resolved));
  scene.look_around(30.0, 0.0);
  const auto off = [&](const Sample& sample, std::size_t i) {
    const Vector3 ray = hit(sample.observation.scan, i);
    const Vector3 direction = sample.map_from_robot->rotation * (1.0 / ray.norm() * ray);
    return ray.norm() - scene.ray_distance(sample.map_from_robot->translation(), direction);
  };
  for (const Sample& sample : read_all()) {
    rays += 16.0 * 360.0;
    for (std::size_t i = 0; i < sample.observation.scan.hits.size(); ++i) {
      squares += std::pow(off(sample, i), 2);
      n += 1.0;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / n), 0.03, 4.0 * 0.03 / std::sqrt(2.0 * n));
  EXPECT_NEAR(n / rays, 0.9, 4.0 * std::sqrt(0.09 / rays));
  params_.lidar.noise = 0.0;
  params_.lidar.outliers = 0.05;
  n = 0.0;
  for (const Sample& sample : read_all()) {
    for (std::size_t i = 0; i < sample.observation.scan.hits.size(); ++i) {
      outliers += std::abs(off(sample, i)) > 1e-3 ? 1.0 : 0.0;
      n += 1.0;
    }
  }
  EXPECT_NEAR(outliers / n, 0.05, 4.0 * std::sqrt(0.05 * 0.95 / n));
}

TEST_F(LidarDrive, OdometryIsThatOfThePlaneWithGravity) {
  LaserDriveParams laser;
  static_cast<DriveParams&>(laser) = params_;
  Simulation simulation(laser, {.seed = 1});
  const auto planar = test::all_of(simulation);
  params_.lidar.beams = 2;
  const auto spatial = read_all();
  ASSERT_EQ(planar.size(), spatial.size());
  for (std::size_t i = 0; i < planar.size(); ++i) {
    const Pose3& odometry = spatial[i].observation.odom_from_robot;
    EXPECT_EQ(odometry.translation(), planar[i].observation.odom_from_robot.translation());
    EXPECT_NEAR(wrap_angle(odometry.heading() - planar[i].observation.odom_from_robot.heading()), 0.0,
                radians(1.0));
    EXPECT_NEAR(odometry.tilt(), spatial[i].map_from_robot->tilt(), radians(0.6));
  }
}

TEST_F(LidarDrive, DependsOnItsSeedOnly) {
  params_.lidar.beams = 4;
  params_.lidar.azimuth_step_deg = 10.0;
  params_.lidar.scan_time = 0.2;
  const auto a = read_all(7);
  const auto b = read_all(7);
  const auto c = read_all(8);
  for (std::size_t i = 1; i < a.size(); ++i) {
    EXPECT_EQ(a[i].observation.scan.hits, b[i].observation.scan.hits);
    EXPECT_EQ(a[i].observation.scan.times, b[i].observation.scan.times);
    EXPECT_EQ(a[i].observation.odom_from_robot, b[i].observation.odom_from_robot);
    EXPECT_EQ(a[i].map_from_robot, b[i].map_from_robot);
    EXPECT_NE(a[i].observation.scan.hits, c[i].observation.scan.hits);
    EXPECT_NE(a[i].observation.odom_from_robot, c[i].observation.odom_from_robot);
  }
}

TEST_F(LidarDrive, CastsRaysInACloud) {
  // A wall of points across the way at x = 3.05 m, from the floor at -1 m to 1 m.
  Points wall;
  for (int y = 0; y < 60; ++y) {
    for (int z = -10; z < 10; ++z)
      wall.push_back({3.05F, 0.1F * static_cast<float>(y) + 0.05F, 0.1F * static_cast<float>(z) + 0.05F});
  }
  folder_.write("wall.pcd", pcd(wall));
  const std::string cloud = "size: [6, 6]\ncloud: wall.pcd\nfloor: -1\nfree_from: [[1, 1]]\n";
  set_world(cloud + "way_points: [[1, 3], [2, 3]]\n");
  params_.lidar = exact(1, 0.0, 0.0, 90.0);
  const Sample sample = read_all()[0];
  EXPECT_EQ(sample.map_from_robot->translation(), (Vector3{1.0, 3.0, 0.0}));
  // The cubes begin with the first point. There is no floor but in the cloud, and nothing to the other sides.
  ASSERT_EQ(sample.observation.scan.hits.size(), 1U);
  EXPECT_NEAR(sample.observation.scan.hits.x[0], 2.05, 1e-5);
  set_world(cloud + "way_points: [[1, 3], [4, 3]]\n");
  EXPECT_THAT(
      fault("lidar: {beams: 4}\n"),
      HasSubstr("world.yaml: error: way_points: 1 m over the floor the way from [2.80, 3.00] to [3.40, "
                "3.00] meets a point of the cloud; move the way points, or change floor"));
}

TEST_F(LidarDrive, MeetsThingsAndPeopleInAnOctree) {
  // A wall of voxels from x = 6 m to 6.1 m and another one from y = 7 m to 7.1 m, up to 3 m.
  std::vector<test::TreeLeaf> leaves;
  for (int i = 0; i < 70; ++i) {
    for (int z = 0; z < 30; ++z) {
      leaves.push_back({.x = 32768 + 60, .y = 32768 + i, .z = 32768 + z});
      leaves.push_back({.x = 32768 + i, .y = 32768 + 70, .z = 32768 + z});
    }
  }
  folder_.write("walls.bt", test::bt_file(leaves, 0.1));
  const std::string world =
      "size: [6, 7]\ncloud: walls.bt\nfree_from: [[1, 1]]\nway_points: [[1, 3], [1.5, 3]]\n";
  params_.lidar = exact(2, -10.0, 0.0, 90.0);
  const double slope = std::tan(radians(10.0));
  // From (1, 3, 1), looking along x. Behind and to the right there is nothing; below 10 degrees the walls are
  // met 5 m away, 0.12 m over the floor, and 4 m away, at 0.29 m.
  const auto hits_of = [&](const std::string& things) {
    set_world(world + things);
    return read_all()[0].observation.scan;
  };
  const Scan walls = hits_of("");
  ASSERT_EQ(walls.hits.size(), 4U);
  EXPECT_NEAR((hit(walls, 0) - Vector3{5.0, 0.0, -5.0 * slope}).norm(), 0.0, 1e-5);
  EXPECT_NEAR((hit(walls, 1) - Vector3{5.0, 0.0, 0.0}).norm(), 0.0, 1e-5);
  EXPECT_NEAR((hit(walls, 2) - Vector3{0.0, 4.0, -4.0 * slope}).norm(), 0.0, 1e-5);
  EXPECT_NEAR((hit(walls, 3) - Vector3{0.0, 4.0, 0.0}).norm(), 0.0, 1e-5);
  // A box of 0.8 m from x = 3 m on, which the level ray passes over, and somebody of a radius of 0.2 m whose
  // middle is at y = 5.5 m.
  const Scan things = hits_of(
      "rectangles: [{centre: [3.5, 3], size: [1, 1], height: 0.8, on_map: false}]\n"
      "people: [{points: [[1, 5.5]]}]\n");
  ASSERT_EQ(things.hits.size(), 4U);
  EXPECT_NEAR((hit(things, 0) - Vector3{2.0, 0.0, -2.0 * slope}).norm(), 0.0, 1e-5);
  EXPECT_NEAR((hit(things, 1) - Vector3{5.0, 0.0, 0.0}).norm(), 0.0, 1e-5);
  EXPECT_NEAR((hit(things, 2) - Vector3{0.0, 2.3, -2.3 * slope}).norm(), 0.0, 1e-5);
  EXPECT_NEAR((hit(things, 3) - Vector3{0.0, 2.3, 0.0}).norm(), 0.0, 1e-5);
}

TEST_F(LidarDrive, SaysWhatIsWrong) {
  EXPECT_EQ(fault("lidar: {beams: 16}\n"), "");
  EXPECT_THAT(fault("lidar: {beams: -1}\n"), HasSubstr("beams"));
  EXPECT_THAT(fault("laser: {fov_deg: 270}\n"), HasSubstr("unknown key 'laser'"));
  EXPECT_THAT(fault("lidar: {beams: 16, vertical_fov_deg: [15, -15]}\n"),
              HasSubstr("vertical_fov_deg: must be rising"));
  EXPECT_THAT(fault("lidar: {beams: 16, max_range: 0.3}\n"), HasSubstr("max_range: must be above 0.5 m"));
  EXPECT_THAT(fault("lidar: {beams: 16, noise: 1e6}\n"),
              HasSubstr("noise: 1e6 is out of range, must be >= 0 and <= 10 m"));
  EXPECT_THAT(fault("lidar: {beams: 16, scan_time: 2}\n"),
              HasSubstr("scan_time must be at most step_seconds"));
  EXPECT_THAT(fault("lidar: {beams: 16, height: 3}\n"), HasSubstr("is not below the ceiling of 2.5 m"));
}

MapData load(const std::filesystem::path& world, double resolution) {
  SimulatedMap::Params params;
  params.world = test::file_path(world);
  params.resolution = resolution;
  params.points = "space";
  return SimulatedMap(params, {}).load();
}

TEST(SimulatedMapInSpace, HasAllSurfaces) {
  const test::TemporaryFolder folder;
  const MapData map = load(folder.write("world.yaml", room), 0.25);
  std::size_t walls = 0;
  std::size_t floor = 0;
  std::size_t ceiling = 0;
  std::size_t at_edges = 0;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Point p = map.points[i];
    const double off = off_the_room({p.x, p.y, p.z});
    ASSERT_LT(off, 0.125) << "the mean in a cube";
    at_edges += off > 1e-5 ? 1U : 0U;
    if (p.x > 0.1 && p.x < 5.9 && p.y > 0.1 && p.y < 3.9) {
      floor += p.z == 0.0F ? 1U : 0U;
      ceiling += p.z == 2.5F ? 1U : 0U;
    } else {
      ++walls;
    }
  }
  EXPECT_EQ(floor, 23U * 15U) << "the free cells of the plan";
  EXPECT_EQ(ceiling, floor);
  EXPECT_LE(at_edges, 4U * 12U);
  // 20 m of walls, 2.5 m high: 16 points for each square metre, and some more at edges.
  EXPECT_GE(walls, 20U * 4U * 10U);
  EXPECT_LE(walls, 21U * 4U * 11U);
  EXPECT_EQ(map.grid.at(1.0, 1.0), Cell::free);
}

TEST(SimulatedMapInSpace, ShowsWhatIsOnTheMapOnly) {
  const test::TemporaryFolder folder;
  const MapData map = load(
      folder.write("world.yaml", std::string(room) +
                                     "rectangles:\n"
                                     "  - {centre: [2, 2], size: [1, 0.6], height: 0.75, in_reality: false}\n"
                                     "  - {centre: [2, 3.4], size: [0.5, 0.5], on_map: false}\n"
                                     "circles: [{centre: [5, 2], radius: 0.5, height: 1.5}]\n"
                                     "unmapped: [{corners: [[5.6, 4], [6, 0]]}]\n"),
      0.1);
  const auto count_near = [&](const Vector3& place, double reach) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      const Point p = map.points[i];
      n += (Vector3{p.x, p.y, p.z} - place).norm() < reach ? 1U : 0U;
    }
    return n;
  };
  EXPECT_GT(count_near({2.0, 2.0, 0.75}, 0.1), 0U) << "the top of the box";
  EXPECT_EQ(count_near({2.0, 2.0, 0.0}, 0.1), 0U) << "no floor below it";
  EXPECT_GT(count_near({1.5, 2.0, 0.4}, 0.1), 0U) << "its side";
  EXPECT_EQ(count_near({2.0, 3.4, 1.0}, 0.4), 0U) << "not on the map";
  EXPECT_GT(count_near({2.0, 3.4, 0.0}, 0.1), 0U) << "but the floor";
  EXPECT_GT(count_near({5.0, 2.0, 1.5}, 0.1), 0U);
  EXPECT_GT(count_near({4.5, 2.0, 1.0}, 0.1), 0U);
  EXPECT_EQ(count_near({6.0, 2.0, 1.0}, 0.3), 0U) << "not mapped";
}

TEST(SimulatedMapInSpace, RefusesTooManyPoints) {
  const test::TemporaryFolder folder;
  const std::filesystem::path world = folder.write("world.yaml", room);
  const auto fault = [&](const std::filesystem::path& file, double resolution) {
    return test::config_error(folder.path(), [&] { static_cast<void>(load(file, resolution)); });
  };
  EXPECT_EQ(
      fault(world, 0.003),
      "world.yaml: error: its surfaces would have more than 16 million points at a resolution of 0.003 m; "
      "raise resolution");
  // A floor of 300 m x 300 m is 9 million cells, and there is a ceiling, too.
  const std::string hall =
      "size: [300, 300]\nwalls: [{points: [[1, 1], [2, 1]]}]\nfree_from: [[5, 5]]\n"
      "way_points: [[5, 5], [6, 5]]\nceiling: 3\n";
  EXPECT_EQ(fault(folder.write("hall.yaml", hall), 0.1),
            "hall.yaml: error: its surfaces would have more than 16 million points at a resolution of 0.1 m; "
            "raise resolution");
  EXPECT_EQ(load(folder / "hall.yaml", 0.5).grid.width, 601);
}

TEST(SimulatedMapInSpace, HasTheCloudAsItIs) {
  const test::TemporaryFolder folder;
  Points points;
  for (int i = 0; i < 100; ++i) points.push_back({0.01F * static_cast<float>(i) + 0.005F, -3.0F, 1.0F});
  folder.write("points.pcd", pcd(points));
  const MapData map = load(
      folder.write("world.yaml",
                   "size: [6, 4]\ncloud: points.pcd\nfree_from: [[1, 1]]\nway_points: [[1, 1], [3, 1]]\n"),
      0.1);
  EXPECT_EQ(map.points.size(), 10U);
  EXPECT_TRUE(map.grid.cells.empty());
  EXPECT_EQ(map.resolution, 0.1);
}

}  // namespace
}  // namespace glocal::simulation::lidar_simulation_test
