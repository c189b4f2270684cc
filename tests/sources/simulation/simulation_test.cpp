#include "sources/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "files.hpp"
#include "samples.hpp"

namespace glocal::simulation::simulation_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A room of 6 m x 3 m with a drive along x, then along y.
constexpr const char* room =
    "size: [6, 3]\n"
    "walls:\n"
    "  - {points: [[0, 0], [6, 0], [6, 3], [0, 3]], closed: true}\n"
    "free_from: [[1, 1]]\n"
    "way_points: [[1, 1], [2.5, 1], [2.5, 2]]\n";

LaserDriveParams exact(const std::filesystem::path& world) {
  LaserDriveParams params;
  params.world = test::file_path(world);
  params.laser.noise = 0.0;
  params.odometry = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  return params;
}

std::vector<Sample> read_all(const LaserDriveParams& params, std::uint64_t seed = 1) {
  Simulation simulation(params, {.seed = seed});
  return test::all_of(simulation);
}

void expect_near(const Pose3& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(rotation_between(a, b), 0.0, 1e-9);
}

TEST(Route, TakesStepsAndTurnsOnTheSpot) {
  const test::TemporaryFolder folder;
  LaserDriveParams params;
  params.world = test::file_path(folder.write("world.yaml", room));
  const auto poses = route_of(WorldWays(read_world(params.world.resolved)), params, Rng(1)).poses;
  ASSERT_EQ(poses.size(), 8U);  // The start, 3 steps of 0.5 m, 2 turns of 45 degrees, 2 steps of 0.5 m.
  expect_near(poses[0], {1, 1, 0});
  expect_near(poses[1], {1.5, 1, 0});
  expect_near(poses[3], {2.5, 1, 0});
  expect_near(poses[4], {2.5, 1, pi / 4});
  expect_near(poses[5], {2.5, 1, pi / 2});
  expect_near(poses[7], {2.5, 2, pi / 2});
}

/// A room of 8 m x 6 m whose ways form a triangle with a tail.
constexpr const char* triangle =
    "size: [8, 6]\n"
    "walls:\n"
    "  - {points: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: true}\n"
    "free_from: [[1, 1]]\n"
    "way_points: [[1, 1], [4, 1], [4, 5], [1, 1], [1, 3]]\n";

/// Places where the robot turns or ends; equal ones that follow one another are one.
std::vector<Position> corners_of(const std::vector<Pose2>& poses) {
  const std::vector<Position> places{{1, 1}, {4, 1}, {4, 5}, {1, 3}};
  std::vector<Position> corners;
  for (const Pose2& pose : poses) {
    for (const Position& place : places) {
      const bool is_there = std::hypot(pose.x - place[0], pose.y - place[1]) < 1e-9;
      if (is_there && (corners.empty() || corners.back() != place)) corners.push_back(place);
    }
  }
  return corners;
}

TEST(Route, OfATourKeepsToTheWaysAndTurnsBackAtDeadEndsOnly) {
  const test::TemporaryFolder folder;
  LaserDriveParams params;
  params.world = test::file_path(folder.write("world.yaml", triangle));
  params.tour_legs = 200;
  const World world = read_world(params.world.resolved);
  const auto corners = corners_of(route_of(WorldWays(world), params, Rng(3)).poses);
  ASSERT_EQ(corners.size(), 201U);
  const std::set<std::pair<Position, Position>> ways{
      {{1, 1}, {4, 1}}, {{4, 1}, {4, 5}}, {{1, 1}, {4, 5}}, {{1, 1}, {1, 3}}};
  std::set<std::pair<Position, Position>> driven;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    driven.insert(std::minmax(corners[i - 1], corners[i]));
    if (i < 2 || corners[i] != corners[i - 2]) continue;
    EXPECT_EQ(corners[i - 1], (Position{1, 3})) << "the dead end";
  }
  EXPECT_EQ(driven, ways);
  EXPECT_EQ(route_of(WorldWays(world), params, Rng(3)).poses,
            route_of(WorldWays(world), params, Rng(3)).poses);
  EXPECT_NE(route_of(WorldWays(world), params, Rng(3)).poses,
            route_of(WorldWays(world), params, Rng(4)).poses);
}

TEST(Route, GoesOnWhereTheRobotIsCarriedTo) {
  const test::TemporaryFolder folder;
  LaserDriveParams params = exact(folder.write("world.yaml", triangle));
  params.step_length = 0.5;
  params.step_turn_deg = 180.0;
  params.kidnappings = {{.after_m = 2.1, .to = {4, 4}, .heading_deg = 180.0}};
  const Route route = route_of(WorldWays(read_world(params.world.resolved)), params, Rng(1));
  // 2.5 m along x, to (4, 4); a turn, 1 m to the nearest way point (4, 5), a turn, 5 m to (1, 1), a turn, 2
  // m.
  ASSERT_EQ(route.carried, (std::vector<std::size_t>{6}));
  ASSERT_EQ(route.poses.size(), 1U + 5U + 1U + 1U + 2U + 1U + 10U + 1U + 4U);
  expect_near(route.poses[5], {3.5, 1, 0});
  expect_near(route.poses[6], {4, 4, pi});
  expect_near(route.poses[7], {4, 4, pi / 2});
  expect_near(route.poses[9], {4, 5, pi / 2});
  expect_near(route.poses.back(), {1, 3, pi / 2});

  const auto samples = read_all(params);
  expect_near(samples[6].observation.odom_from_robot,
              seen_from_above(samples[5].observation.odom_from_robot));
  expect_near(samples[9].observation.odom_from_robot, {2.5, -1, -pi / 2});
  EXPECT_EQ(samples[6].segment, samples[5].segment) << "nobody tells the robot";
}

TEST(Route, SaysWhyARobotCannotBeCarriedThere) {
  const test::TemporaryFolder folder;
  LaserDriveParams params;
  params.world = test::file_path(
      folder.write("world.yaml", std::string(triangle) + "rectangles: [{centre: [6, 3], size: [1, 4]}]\n"));
  const auto fault = [&](const Kidnapping& kidnapping) {
    params.kidnappings = {kidnapping};
    return test::config_error(params.world.resolved.parent_path(), [&] { Simulation(params, {.seed = 1}); });
  };
  EXPECT_EQ(
      fault({.after_m = 2.0, .to = {7.5, 3}}),
      "world.yaml: error: kidnappings[0]: the way from [7.5, 3] to the nearest way point [4, 1] meets a "
      "wall or thing, or has no length; put the robot down elsewhere");
  EXPECT_NE(fault({.after_m = 2.0, .to = {4, 1}}), "");
  EXPECT_EQ(fault({.after_m = 50.0, .to = {3, 3}}),
            "world.yaml: error: kidnappings[0]: the drive is over after 14.0 m; lower after_m from 50 m, or "
            "drive farther");
  EXPECT_EQ(fault({.after_m = 2.0, .to = {3, 3}}), "");
}

TEST(Simulation, MeasuresDistancesExactlyWithoutNoise) {
  const test::TemporaryFolder folder;
  LaserDriveParams params = exact(folder.write("world.yaml", room));
  params.laser.step_deg = 90.0;
  params.laser.max_range = 4.0;
  const auto samples = read_all(params);
  // At (1, 1) looking along x: 1 m to the right, 5 m ahead (too far), 2 m to the left.
  const Scan& scan = samples[0].observation.scan;
  ASSERT_EQ(scan.hits.size(), 2U);
  EXPECT_NEAR(scan.hits[0].y, -1.0, 1e-6);
  EXPECT_NEAR(scan.hits[1].y, 2.0, 1e-6);
  ASSERT_EQ(scan.free_ends.size(), 1U);
  EXPECT_NEAR(scan.free_ends[0].x, 4.0, 1e-6);
  // At (2.5, 2) looking along y: 3.5 m to the right, 1 m ahead, 2.5 m to the left.
  const Scan& last = samples.back().observation.scan;
  ASSERT_EQ(last.hits.size(), 3U);
  EXPECT_NEAR(last.hits[0].y, -3.5, 1e-6);
  EXPECT_NEAR(last.hits[1].x, 1.0, 1e-6);
  EXPECT_NEAR(last.hits[2].y, 2.5, 1e-6);
}

TEST(Simulation, SeesWhatIsThereAndNotWhatTheMapShows) {
  const test::TemporaryFolder folder;
  LaserDriveParams params = exact(
      folder.write("world.yaml", std::string(room) + "circles:\n"
                                                     "  - {centre: [4, 1], radius: 0.5, in_reality: false}\n"
                                                     "  - {centre: [5, 1], radius: 0.5, on_map: false}\n"
                                                     "people:\n"
                                                     "  - {points: [[1, 2.5], [6, 2.5]], speed: 1}\n"));
  params.laser.step_deg = 90.0;
  const auto samples = read_all(params);
  EXPECT_NEAR(samples[0].observation.scan.hits[1].x, 3.5, 1e-6);
  EXPECT_NEAR(samples[0].observation.scan.hits[2].y, 1.3, 1e-6) << "the walker stands 1.5 m to the left";
  EXPECT_NEAR(samples[3].observation.scan.hits[2].y, 2.0, 1e-6) << "and has gone on";
}

TEST(Simulation, MountsTheLaser) {
  const test::TemporaryFolder folder;
  LaserDriveParams params = exact(folder.write("world.yaml", room));
  params.laser = {.fov_deg = 90.0, .step_deg = 90.0, .noise = 0.0, .x = 0.5, .y = 0.25, .yaw_deg = 45.0};
  const auto samples = read_all(params);
  const Scan& scan =
      samples[0].observation.scan;  // The laser is at (1.5, 1.25); its rays go ahead and to the left.
  EXPECT_NEAR(scan.origin.x, 0.5, 1e-6);
  EXPECT_NEAR(scan.origin.y, 0.25, 1e-6);
  ASSERT_EQ(scan.hits.size(), 2U);
  EXPECT_NEAR(scan.hits[0].x, 5.0, 1e-6);
  EXPECT_NEAR(scan.hits[0].y, 0.25, 1e-6);
  EXPECT_NEAR(scan.hits[1].x, 0.5, 1e-6);
  EXPECT_NEAR(scan.hits[1].y, 2.0, 1e-6);
}

TEST(Simulation, NoiseHasItsSize) {
  const test::TemporaryFolder folder;
  LaserDriveParams params = exact(folder.write("world.yaml", room));
  params.laser.fov_deg = 0.1;  // All rays meet the wall 5 m ahead.
  params.laser.step_deg = 0.01;
  params.laser.noise = 0.02;
  params.step_length = 0.01;
  double sum = 0.0;
  double squares = 0.0;
  double n = 0.0;
  for (const Sample& sample : read_all(params)) {
    if (sample.map_from_robot->heading() != 0.0) break;
    for (const float x : sample.observation.scan.hits.x) {
      const double error = sample.map_from_robot->x + x - 6.0;
      sum += error;
      squares += error * error;
      n += 1.0;
    }
  }
  ASSERT_GT(n, 1000.0);
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * n));
}

TEST(Simulation, OutliersHaveTheirShare) {
  const test::TemporaryFolder folder;
  LaserDriveParams params = exact(folder.write("world.yaml", room));
  params.step_length = 0.01;
  const auto clean = read_all(params);
  params.laser.outliers = 0.05;
  const auto dirty = read_all(params);
  double changed = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const auto& a = clean[i].observation.scan.hits;
    const auto& b = dirty[i].observation.scan.hits;
    ASSERT_EQ(a.size(), b.size()) << "all walls are within range, and so are all outliers";
    for (std::size_t k = 0; k < a.size(); ++k) changed += a[k] == b[k] ? 0.0 : 1.0;
    all += static_cast<double>(a.size());
  }
  EXPECT_NEAR(changed / all, 0.05, 4.0 * std::sqrt(0.05 * 0.95 / all));
}

TEST(Simulation, OdometryIsExactWithoutErrors) {
  const test::TemporaryFolder folder;
  const auto samples = read_all(exact(folder.write("world.yaml", room)));
  for (const Sample& sample : samples) {
    expect_near(*samples[0].map_from_robot * sample.observation.odom_from_robot,
                seen_from_above(*sample.map_from_robot));
  }
}

TEST(Simulation, OdometryDriftsWithDistanceAndTurn) {
  const test::TemporaryFolder folder;
  LaserDriveParams params = exact(folder.write("world.yaml", room));
  params.odometry.distance_bias = 0.1;
  auto samples = read_all(params);
  expect_near(samples.back().observation.odom_from_robot, {1.65, 1.1, pi / 2});
  params.odometry = {0.0, 0.0, 0.1, 0.0, 0.0, 0.0};
  samples = read_all(params);
  EXPECT_NEAR(samples.back().observation.odom_from_robot.heading(), 1.1 * pi / 2, 1e-9);
  params.odometry = {0.0, 0.0, 0.0, 0.0, 2.0, 0.0};
  samples = read_all(params);
  EXPECT_NEAR(degrees(samples.back().observation.odom_from_robot.heading()), 90.0 + 2.0 * 2.5, 1e-9);
}

TEST(Simulation, DependsOnItsSeedOnly) {
  const test::TemporaryFolder folder;
  LaserDriveParams params;
  params.world = test::file_path(folder.write("world.yaml", room));
  const auto a = read_all(params, 7);
  const auto b = read_all(params, 7);
  const auto c = read_all(params, 8);
  for (std::size_t i = 1; i < a.size(); ++i) {
    EXPECT_EQ(a[i].observation.scan.hits, b[i].observation.scan.hits);
    EXPECT_EQ(a[i].observation.odom_from_robot, b[i].observation.odom_from_robot);
    EXPECT_NE(a[i].observation.scan.hits, c[i].observation.scan.hits);
    EXPECT_NE(a[i].observation.odom_from_robot, c[i].observation.odom_from_robot);
    EXPECT_EQ(*a[i].map_from_robot, *c[i].map_from_robot);
  }
}

MapData load(const test::TemporaryFolder& folder, const std::string& yaml, double resolution) {
  return SimulatedMap({test::file_path(folder.write("world.yaml", yaml)), resolution}, {}).load();
}

std::size_t count(const OccupancyGrid& grid, Cell kind) {
  return static_cast<std::size_t>(std::count(grid.cells.begin(), grid.cells.end(), kind));
}

TEST(SimulatedMap, DrawsWallsOneCellThickWhereTheyStand) {
  const test::TemporaryFolder folder;
  const MapData map = load(folder, room, 0.5);
  EXPECT_EQ(map.grid.width, 13);
  EXPECT_EQ(map.grid.height, 7);
  EXPECT_EQ(map.points.size(), 36U);  // The rim of 13 x 7 cells.
  EXPECT_EQ(count(map.grid, Cell::occupied), 36U);
  EXPECT_EQ(count(map.grid, Cell::free), 55U);
  EXPECT_EQ(map.points[0], (Point{0, 0, 0}));
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Point p = map.points[i];
    EXPECT_TRUE(p.x == 0.0F || p.x == 6.0F || p.y == 0.0F || p.y == 3.0F);
  }
}

TEST(SimulatedMap, ShowsWhatIsOnTheMapOnly) {
  const test::TemporaryFolder folder;
  const MapData map = load(folder,
                           std::string(room) +
                               "circles: [{centre: [3, 1.5], radius: 0.1, on_map: false}]\n"
                               "rectangles: [{centre: [4.5, 1.5], size: [1, 1], in_reality: false}]\n"
                               "unmapped: [{corners: [[0, 3], [1, 0]]}]\n",
                           0.5);
  EXPECT_EQ(map.grid.at(3.0, 1.5), Cell::free);
  EXPECT_EQ(map.grid.at(4.0, 1.5), Cell::occupied);
  EXPECT_EQ(map.grid.at(4.5, 1.5), Cell::unknown) << "nobody has looked into the box";
  EXPECT_EQ(map.grid.at(0.5, 1.0), Cell::unknown);
  EXPECT_EQ(map.grid.at(0.5, 0.0), Cell::unknown) << "not even the wall";
  EXPECT_EQ(map.points.size(), 36U - 11U + 8U);
}

TEST(SimulatedMap, FreeSpaceStaysWithinSlantedWalls) {
  const test::TemporaryFolder folder;
  const MapData map = load(folder,
                           "size: [9, 9]\n"
                           "walls: [{points: [[1, 1], [8, 3.3], [4.2, 7.7]], closed: true}]\n"
                           "free_from: [[4, 4]]\n"
                           "way_points: [[4, 4], [4.5, 4]]\n",
                           0.1);
  EXPECT_EQ(map.grid.at(0.5, 0.5), Cell::unknown);
  EXPECT_EQ(map.grid.at(8.5, 8.5), Cell::unknown);
  // The triangle's area by the shoelace formula: |7 * 6.7 - 2.3 * 3.2| / 2 = 19.77 m^2, less half the cells
  // of its outline.
  const double cells = (19.77 * 100.0) - static_cast<double>(map.points.size()) / 2.0;
  EXPECT_NEAR(static_cast<double>(count(map.grid, Cell::free)), cells, 0.01 * cells);
}

TEST(SimulatedMap, SaysWhyThereIsNoMap) {
  const test::TemporaryFolder folder;
  const auto message = [&](const std::string& yaml, double resolution) {
    return test::config_error(folder / "", [&] { static_cast<void>(load(folder, yaml, resolution)); });
  };
  EXPECT_NE(message("size: [2, 2]\nfree_from: [[1, 1]]\nway_points: [[1, 1], [1, 2]]\n", 0.5)
                .find("has nothing on its map; give it walls with on_map: true"),
            std::string::npos);
  EXPECT_NE(message(room, 1e-6).find("more than 1000 million cells"), std::string::npos);
}

TEST(Worlds, OfThePaperAreReadAndHaveItsSizes) {
  const std::filesystem::path folder = std::filesystem::path(GLOCAL_SOURCE_DIR) / "configs/worlds";
  const auto points = [&](const char* name) {
    return SimulatedMap({test::file_path(folder / name), 0.03}, {}).load().points;
  };
  const auto extent = [](const std::vector<float>& v) {
    return *std::max_element(v.begin(), v.end()) - *std::min_element(v.begin(), v.end());
  };
  const Points corridors = points("paper_simulation.yaml");
  EXPECT_NEAR(extent(corridors.x), 26.16, 1e-4);
  EXPECT_NEAR(extent(corridors.y), 26.7, 1e-4);
  LaserDriveParams params;
  params.world = test::file_path(folder / "paper_simulation.yaml");
  EXPECT_EQ(read_all(params).size(), 136U);
  EXPECT_FALSE(points("paper_symmetry.yaml").empty());
  EXPECT_NEAR(extent(points("paper_lab.yaml").y), 14.0, 0.02);
}

TEST(Route, OfMoreThanAMillionObservationsIsRefused) {
  const test::TemporaryFolder folder;
  LaserDriveParams params;
  params.world = test::file_path(folder.write("world.yaml", room));
  params.tour_legs = 100000;
  params.step_length = 0.001;
  EXPECT_EQ(
      test::config_error(
          folder.path(),
          [&] { static_cast<void>(route_of(WorldWays(read_world(params.world.resolved)), params, Rng(1))); }),
      "error: simulation: the drive has more than a million observations; raise step_length and "
      "step_turn_deg, or lower tour_legs");
}

TEST(Route, OfATourBetweenManyPlacesIsQuick) {
  std::vector<Position> star;
  for (int i = 0; i < 10000; ++i) star.push_back({i % 2 == 0 ? 0.0 : 1.0 + i, 1.0});
  World world;
  world.way_points = star;
  LaserDriveParams params;
  params.tour_legs = 2000;
  params.step_length = 1e6;
  params.step_turn_deg = 180.0;
  EXPECT_GT(route_of(WorldWays(world), params, Rng(1)).poses.size(), 2000U);
}

}  // namespace
}  // namespace glocal::simulation::simulation_test
