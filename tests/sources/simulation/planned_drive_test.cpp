#include "sources/simulation/planned_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "glocal/yaml.hpp"
#include "octree_files.hpp"
#include "samples.hpp"
#include "sources/plan.hpp"
#include "sources/simulation/lidar_simulation.hpp"
#include "sources/simulation/scene.hpp"
#include "sources/simulation/simulation.hpp"
#include "sources/simulation/world_grid.hpp"

namespace glocal::simulation::planned_drive_test {
namespace {

constexpr double pi = std::numbers::pi;

/// 20 m x 14 m in cells of 0.5 m: three rooms and a hall with a pillar. The door of the room at the right is
/// narrow.
const std::vector<std::string> floor_plan{
    "########################################",  //
    "#............#............#............#",  //
    "#............#............#............#",  //
    "#............#............#............#",  //
    "#............#............#............#",  //
    "#.........................#............#",  //
    "#.........................#............#",  //
    "#.........................#............#",  //
    "#.........................#............#",  //
    "#.........................#............#",  //
    "#............#............#............#",  //
    "#............#............#............#",  //
    "#............#............#............#",  //
    "######.....###################...#######",  //
    "#......................................#",  //
    "#......................................#",  //
    "#......................................#",  //
    "#......................................#",  //
    "#......................................#",  //
    "#......................................#",  //
    "#..............###.....................#",  //
    "#..............###.....................#",  //
    "#..............###.....................#",  //
    "#......................................#",  //
    "#......................................#",  //
    "#................................??????#",  //
    "#................................??????#",  //
    "########################################",  //
};

LaserDriveParams params_in(const test::Plan& plan) {
  LaserDriveParams params;
  params.map = plan.file();
  params.tour_legs = 12;
  return params;
}

/// Distance from a place to the nearest cell that is not free, m; by looking at all of them.
double clearance_at(const OccupancyGrid& grid, const Pose2& place) {
  const Pose2 p = inverse(grid.map_from_grid) * place;
  double nearest = 1e9;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.cell(column, row) == Cell::free) continue;
      const double dx = std::abs(p.x - (column + 0.5) * grid.resolution) - grid.resolution / 2.0;
      const double dy = std::abs(p.y - (row + 0.5) * grid.resolution) - grid.resolution / 2.0;
      nearest = std::min(nearest, std::hypot(std::max(dx, 0.0), std::max(dy, 0.0)));
    }
  }
  return nearest;
}

TEST(PlannedDrive, KeepsClearOfAllThatIsNotFree) {
  for (const char* origin : {"[0, 0, 0]", "[-3, 7, 1.1]"}) {
    const test::Plan plan(floor_plan, origin);
    const PlannedDrive drive = planned_drive(params_in(plan), {.seed = 4});
    ASSERT_GT(drive.route.poses.size(), 100U);
    for (std::size_t i = 0; i < drive.route.poses.size(); ++i) {
      ASSERT_GE(clearance_at(*drive.map, drive.route.poses[i]), 0.3 - 1e-9) << "pose " << i;
      if (i == 0) continue;
      const Pose2& from = drive.route.poses[i - 1];
      const Pose2& to = drive.route.poses[i];
      EXPECT_LE(distance(from, to), 0.6 + 1e-9);
      EXPECT_LE(rotation_between(from, to), pi / 4.0 + 1e-9);
      if (distance(from, to) > 1e-9) {
        EXPECT_NEAR(wrap_angle(std::atan2(to.y - from.y, to.x - from.x) - to.theta), 0.0, 1e-6);
      }
    }
  }
}

TEST(PlannedDrive, ComesByItsWayPoints) {
  const test::Plan plan(floor_plan);
  LaserDriveParams params = params_in(plan);
  params.tour_legs = 0;
  params.way_points = {{1.75, 9.25}, {16.75, 9.25}, {2.25, 1.75}};
  const std::vector<Pose2> poses = planned_drive(params, {}).route.poses;
  auto at = poses.begin();
  for (const Position& place : params.way_points) {
    at = std::find_if(at, poses.end(), [&](const Pose2& pose) {
      return std::hypot(pose.x - place[0], pose.y - place[1]) < 1e-9;
    });
    ASSERT_NE(at, poses.end());
  }
  // A tour drives the ways between them, there and back again.
  params.tour_legs = 5;
  EXPECT_GT(planned_drive(params, {}).route.poses.size(), 1.5 * static_cast<double>(poses.size()));
}

TEST(PlannedDrive, InAMapFarAwayIsTheSameFarAway) {
  const auto read_all = [](const test::Plan& plan, double x, double y) {
    LaserDriveParams params = params_in(plan);
    params.tour_legs = 0;
    params.way_points = {{x + 1.25, y + 1.75}, {x + 14.75, y + 1.75}};
    params.kidnappings = {{.after_m = 3.0, .to = {x + 1.75, y + 9.25}, .heading_deg = 90.0}};
    params.boxes = 2;
    Simulation drive(params, SourceSetup{.seed = 4});
    return test::all_of(drive);
  };
  const std::vector<Sample> near = read_all(test::Plan(floor_plan, "[0, 0, 0]"), 0.0, 0.0);
  const std::vector<Sample> far =
      read_all(test::Plan(floor_plan, "[500000, 4649776, 0]"), 500'000.0, 4'649'776.0);
  ASSERT_EQ(far.size(), near.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    ASSERT_EQ(far[i].observation.scan.hits, near[i].observation.scan.hits);
    ASSERT_EQ(far[i].observation.scan.free_ends, near[i].observation.scan.free_ends);
    EXPECT_EQ(far[i].observation.odom_from_robot, near[i].observation.odom_from_robot);
    EXPECT_NEAR(far[i].map_from_robot->x, near[i].map_from_robot->x + 500'000.0, 1e-9);
    EXPECT_NEAR(far[i].map_from_robot->y, near[i].map_from_robot->y + 4'649'776.0, 1e-9);
  }
  const test::Plan plan(floor_plan, "[500000, 4649776, 0]");
  EXPECT_THAT(test::config_error(plan.folder(), [&] { read_all(plan, 500'005.5, 4'649'776.0); }),
              testing::HasSubstr("way_points[1]: [500020.25, 4649777.75] lies in no free cell"));
}

TEST(PlannedDrive, GoesOnToWhereItWasGoing) {
  const test::Plan plan(floor_plan);
  LaserDriveParams params = params_in(plan);
  params.tour_legs = 0;
  params.way_points = {{1.25, 1.75}, {14.75, 1.75}};
  params.step_length = 0.5;
  params.kidnappings = {{.after_m = 3.0, .to = {1.75, 9.25}, .heading_deg = 90.0}};
  const Route route = planned_drive(params, {}).route;
  ASSERT_EQ(route.carried.size(), 1U);
  const Pose2& put_down = route.poses[route.carried[0]];
  EXPECT_EQ(put_down.x, 1.75);
  EXPECT_EQ(put_down.y, 9.25);
  EXPECT_NEAR(put_down.theta, pi / 2.0, 1e-12);
  EXPECT_NEAR(route.poses.back().x, 14.75, 1e-9);
  EXPECT_NEAR(route.poses.back().y, 1.75, 1e-9);
  params.kidnappings = {{.after_m = 3.0, .to = {6.75, 8.25}, .heading_deg = 90.0}};
  const auto fault = [&] {
    return test::config_error(plan.folder(), [&] { static_cast<void>(planned_drive(params, {})); });
  };
  EXPECT_EQ(
      fault(),
      "map.yaml: error: kidnappings[0]: [6.75, 8.25] lies in no free cell of the map; move it onto free "
      "space");
  params.kidnappings[0].to = {15.75, 9.25};
  params.clearance = 0.6;
  params.way_points = {{1.75, 1.75}, {14.75, 1.75}};
  EXPECT_EQ(
      fault(),
      "map.yaml: error: kidnappings[0]: [15.75, 9.25] cannot be reached from [1.75, 1.75] with a clearance "
      "of 0.6 m; move it, or lower clearance");
}

TEST(PlannedDrive, HasBoxesAndPeopleByNumber) {
  const test::Plan plan(floor_plan);
  LaserDriveParams params = params_in(plan);
  params.tour_legs = 3;
  params.boxes = 6;
  params.people = 4;
  const PlannedDrive drive = planned_drive(params, {.seed = 2});
  EXPECT_EQ(drive.world.rectangles.size(), 6U);
  EXPECT_EQ(drive.world.people.size(), 4U);
  EXPECT_TRUE(shapes_on_map(drive.world).segments.empty());
  const Shapes boxes = shapes_in_reality(drive.world);
  EXPECT_EQ(boxes.segments.size(), 24U);
  for (const Pose2& pose : drive.route.poses) EXPECT_GE(clearance(boxes, {pose.x, pose.y}), 0.3);
  const auto first_box = [&](std::uint64_t seed) {
    return planned_drive(params, {.seed = seed}).world.rectangles[0].centre;
  };
  EXPECT_EQ(first_box(2), drive.world.rectangles[0].centre);
  EXPECT_NE(first_box(3), drive.world.rectangles[0].centre);
  params.boxes = params.people = 0;
  EXPECT_EQ(planned_drive(params, {.seed = 2}).route.poses, drive.route.poses) << "they change no drive";
}

TEST(PlannedDrive, SeesWallsBoxesAndPeople) {
  const test::Plan plan(floor_plan);
  LaserDriveParams params = params_in(plan);
  params.boxes = 8;
  params.people = 5;
  params.tour_legs = 6;
  params.laser.noise = 0.0;
  params.laser.max_range = 6.0;
  params.max_unknown = 0.0;
  const PlannedDrive drive = planned_drive(params, {.seed = 1});
  const Shapes boxes = shapes_in_reality(drive.world);
  Simulation simulation(params, {.seed = 1});
  int on_walls = 0;
  int on_boxes = 0;
  int on_people = 0;
  while (const auto sample = simulation.next()) {
    const std::vector<Circle> people = people_at(drive.world, sample->observation.stamp);
    const Pose2 pose = seen_from_above(*sample->map_from_robot);
    const Scan& scan = sample->observation.scan;
    for (std::size_t i = 0; i < scan.hits.size(); ++i) {
      const Pose2 hit = pose * Pose2{scan.hits.x[i], scan.hits.y[i], 0.0};
      const bool is_on_person = clearance({{}, people, {}}, {hit.x, hit.y}) < 1e-5;
      const bool is_on_box = clearance(boxes, {hit.x, hit.y}) < 1e-5;
      const bool is_on_wall = clearance_at(*drive.map, hit) < 1e-5;
      ASSERT_TRUE(is_on_person || is_on_box || is_on_wall);
      on_people += is_on_person ? 1 : 0;
      on_boxes += is_on_box ? 1 : 0;
      on_walls += is_on_wall ? 1 : 0;
    }
    for (std::size_t i = 0; i < scan.free_ends.size(); i += 20) {
      const Pose2 end = pose * Pose2{scan.free_ends.x[i], scan.free_ends.y[i], 0.0};
      EXPECT_EQ(drive.map->at(end.x, end.y), Cell::free);
    }
  }
  EXPECT_GT(on_walls, 5000);
  EXPECT_GT(on_boxes, 500);
  EXPECT_GT(on_people, 100);
}

/// A hall of 10 m x 8 m with a wall that only the map shows.
constexpr const char* hall =
    "size: [10, 8]\n"
    "walls:\n"
    "  - {points: [[0, 0], [10, 0], [10, 8], [0, 8]], closed: true}\n"
    "  - {points: [[5, 0], [5, 8]], in_reality: false}\n"
    "people: [{points: [[1, 7], [9, 7]]}]\n"
    "free_from: [[1, 1]]\n"
    "way_points: [[1, 1], [9, 1], [9, 7]]\n";

TEST(PlannedDrive, HasBoxesAndPeopleInWorldsToo) {
  const test::TemporaryFolder folder;
  LaserDriveParams params;
  params.world = test::file_path(folder.write("world.yaml", hall));
  params.boxes = 10;
  params.people = 3;
  const PlannedDrive drive = planned_drive(params, {.seed = 1});
  ASSERT_EQ(drive.world.rectangles.size(), 10U);
  EXPECT_EQ(drive.world.people.size(), 4U);
  const World empty = read_world(params.world.resolved);
  const OccupancyGrid grid = reality_of(empty);
  for (const Rectangle& box : drive.world.rectangles)
    EXPECT_EQ(grid.at(box.centre[0], box.centre[1]), Cell::free);
  EXPECT_TRUE(std::any_of(drive.world.rectangles.begin(), drive.world.rectangles.end(),
                          [](const Rectangle& box) { return box.centre[0] > 5.0; }))
      << "beyond the wall that is not there";
  const Shapes things = shapes_in_reality(drive.world);
  for (const Pose2& pose : drive.route.poses) EXPECT_GE(clearance(things, {pose.x, pose.y}), 0.3);
  EXPECT_EQ(shapes_on_map(drive.world).segments.size(), shapes_on_map(empty).segments.size());
}

TEST(PlannedDrive, ShowsBoxesToALidar) {
  const test::TemporaryFolder folder;
  LidarDriveParams params;
  params.world = test::file_path(folder.write("world.yaml", hall));
  params.lidar.beams = 8;
  params.lidar.noise = params.lidar.outliers = params.lidar.tilt_deg = 0.0;
  params.boxes = 10;
  const Shapes boxes = [&] {
    World world = planned_drive(params, {.seed = 1}).world;
    world.walls.clear();
    return shapes_in_reality(world);
  }();
  LidarSimulation source(params, {.seed = 1});
  std::size_t on_boxes = 0;
  while (const auto sample = source.next()) {
    const Scan& scan = sample->observation.scan;
    for (std::size_t i = 0; i < scan.hits.size(); ++i) {
      const Vector3 hit = *sample->map_from_robot * Vector3{scan.hits.x[i], scan.hits.y[i], scan.hits.z[i]};
      on_boxes += hit.z() > 0.05 && clearance(boxes, {hit.x(), hit.y()}) < 1e-4 ? 1U : 0U;
    }
  }
  EXPECT_GT(on_boxes, 500U);
}

/// A hall of 20 m x 8 m whose floor at -0.5 m, wall along y = 6 m and pillar are voxels of 0.1 m.
class OctreeHall : public testing::Test {
 protected:
  OctreeHall() {
    std::vector<test::TreeLeaf> leaves;
    const auto put = [&](int x, int y, int z) {
      leaves.push_back({.x = 32768 + x, .y = 32768 + y, .z = 32768 + z});
    };
    for (int x = 0; x < 200; ++x) {
      for (int y = 0; y < 80; ++y) put(x, y, -5);
      for (int z = -4; z < 20; ++z) put(x, 60, z);
    }
    for (int z = -4; z < 20; ++z) put(100, 30, z);
    folder_.write("hall.bt", test::bt_file(leaves, 0.1));
    params_.world =
        test::file_path(folder_.write("world.yaml",
                                      "size: [20, 8]\ncloud: hall.bt\nfloor: -0.45\nfree_from: [[1, 1]]\n"
                                      "way_points: [[1, 2], [18, 2]]\n"));
    params_.boxes = 6;
    params_.people = 4;
    params_.lidar.beams = 16;
    params_.lidar.min_range = 0.0;
    params_.lidar.noise = params_.lidar.outliers = params_.lidar.dropped = 0.0;
  }

  test::TemporaryFolder folder_;
  LidarDriveParams params_;
};

/// Distance to a box on a floor, by the slabs between its pairs of faces; infinite if it is not met.
double distance_to_box(const Rectangle& box, double floor, const Vector3& origin, const Vector3& direction) {
  const Pose3 map_from_box({box.centre[0], box.centre[1], floor}, turn_about_z(radians(box.angle_deg)));
  const Vector3 from = inverse(map_from_box) * origin;
  const Vector3 along = inverse(map_from_box).rotation * direction;
  double enter = 0.0;
  double leave = 1e9;
  const auto cut = [&](double low, double high, double at, double step) {
    enter = std::max(enter, std::min((low - at) / step, (high - at) / step));
    leave = std::min(leave, std::max((low - at) / step, (high - at) / step));
  };
  cut(-box.size[0] / 2.0, box.size[0] / 2.0, from.x(), along.x());
  cut(-box.size[1] / 2.0, box.size[1] / 2.0, from.y(), along.y());
  cut(0.0, box.height, from.z(), along.z());
  return enter < leave ? enter : std::numeric_limits<double>::infinity();
}

/// The same of a column that is met from outside, by its side or its top.
double distance_to_column(const Circle& column, double floor, const Vector3& origin,
                          const Vector3& direction) {
  const double dx = origin.x() - column.centre[0];
  const double dy = origin.y() - column.centre[1];
  const double a = direction.x() * direction.x() + direction.y() * direction.y();
  const double b = dx * direction.x() + dy * direction.y();
  const double root = std::sqrt(b * b - a * (dx * dx + dy * dy - column.radius * column.radius));
  const double to_top = (floor + column.height - origin.z()) / direction.z();
  const double at_side = origin.z() + (-b - root) / a * direction.z() - floor;
  if (at_side >= 0.0 && at_side <= column.height && b < 0.0) return (-b - root) / a;
  const bool is_on_top =
      to_top > 0.0 && std::hypot(dx + to_top * direction.x(), dy + to_top * direction.y()) < column.radius;
  return is_on_top ? to_top : std::numeric_limits<double>::infinity();
}

TEST_F(OctreeHall, HasBoxesAndPeopleOnItsFloor) {
  const PlannedDrive drive = planned_drive(params_, {.seed = 3});
  ASSERT_EQ(drive.world.rectangles.size(), 6U);
  ASSERT_EQ(drive.world.people.size(), 4U);
  const Shapes boxes = shapes_in_reality(drive.world);
  for (const Pose2& pose : drive.route.poses) EXPECT_GE(clearance(boxes, {pose.x, pose.y}), 0.3);
  const auto expect_free = [](const Position& place, double margin) {
    EXPECT_GE(place[0], margin);
    EXPECT_LE(place[0], 20.0 - margin);
    EXPECT_GE(place[1], margin);
    EXPECT_LE(place[1], 6.0 - margin) << "not behind the wall";
    EXPECT_GE(std::max(std::abs(place[0] - 10.05), std::abs(place[1] - 3.05)), 0.05 + margin) << "the pillar";
  };
  for (const Rectangle& box : drive.world.rectangles) {
    EXPECT_FALSE(box.presence.on_map);
    expect_free({box.centre[0], box.centre[1]}, 0.1);
  }
  for (const Segment& side : boxes.segments) expect_free(side.from, 0.0);
  for (const Walker& walker : drive.world.people) {
    for (std::size_t i = 1; i < walker.points.size(); ++i) {
      for (int k = 0; k <= 50; ++k)
        expect_free(between(walker.points[i - 1], walker.points[i], k / 50.0), 0.15);
    }
  }
  EXPECT_EQ(planned_drive(params_, {.seed = 3}).world.rectangles[0].centre, drive.world.rectangles[0].centre);
  EXPECT_NE(planned_drive(params_, {.seed = 4}).world.rectangles[0].centre, drive.world.rectangles[0].centre);
}

TEST_F(OctreeHall, ShowsThemToALidar) {
  const PlannedDrive drive = planned_drive(params_, {.seed = 3});
  constexpr double floor = -0.45;
  std::size_t step = 0;
  int on_boxes = 0;
  int on_people = 0;
  int on_voxels = 0;
  Scene scene(drive.world, drive.cloud);
  for (const Pose2& pose : drive.route.poses) {
    const double time = static_cast<double>(step++) * params_.step_seconds;
    scene.look_around(30.0, time);
    for (int ray = 0; ray < 2000; ++ray) {
      const double azimuth = 0.1 + 2.0 * pi * ray / 100.0;
      const int ring = ray / 100;
      const double elevation = radians(-15.0 + 1.4 * ring);
      const Vector3 origin{pose.x, pose.y, floor + 1.0};
      const Vector3 direction{std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      double box = std::numeric_limits<double>::infinity();
      for (const Rectangle& b : drive.world.rectangles)
        box = std::min(box, distance_to_box(b, floor, origin, direction));
      double person = std::numeric_limits<double>::infinity();
      for (const Circle& column : people_at(drive.world, time)) {
        const double away = std::hypot(column.centre[0] - pose.x, column.centre[1] - pose.y);
        if (away > column.radius)
          person = std::min(person, distance_to_column(column, floor, origin, direction));
      }
      const double voxel = scene.cloud_distance(origin, direction, 30.0);
      const double expected = std::min({box, person, voxel});
      const double distance = scene.ray_distance(origin, direction);
      if (expected < 30.0) {
        ASSERT_NEAR(distance, expected, 1e-9) << "step " << step << ", ray " << ray;
      }
      on_boxes += box < std::min({person, voxel, 30.0}) ? 1 : 0;
      on_people += person < std::min({box, voxel, 30.0}) ? 1 : 0;
      on_voxels += voxel < std::min(box, person) ? 1 : 0;
    }
  }
  EXPECT_GT(on_boxes, 500);
  EXPECT_GT(on_people, 500);
  EXPECT_GT(on_voxels, 10000);
}

TEST_F(OctreeHall, IsReadOnlyByThoseWhoAskForIt) {
  const auto inputs = [](const auto& params) {
    std::vector<std::string> names;
    SourceSetup setup;
    setup.note_input = [&](const std::filesystem::path& file) { names.push_back(file.filename()); };
    static_cast<void>(planned_drive(params, setup));
    return names;
  };
  const std::vector<std::string> both = {"world.yaml", "hall.bt"};
  EXPECT_EQ(inputs(params_), both);
  params_.boxes = params_.people = 0;
  EXPECT_EQ(inputs(params_), both);
  LaserDriveParams laser;
  static_cast<DriveParams&>(laser) = params_;
  EXPECT_EQ(inputs(laser), (std::vector<std::string>{"world.yaml"}));
  laser.people = 1;
  EXPECT_EQ(inputs(laser), both);
}

TEST(PlannedDrive, NotesTheFilesItReads) {
  const test::Plan plan(floor_plan);
  std::vector<std::string> names;
  SourceSetup setup;
  setup.note_input = [&](const std::filesystem::path& file) { names.push_back(file.filename()); };
  static_cast<void>(planned_drive(params_in(plan), setup));
  EXPECT_EQ(names, (std::vector<std::string>{"map.yaml", "map.pgm"}));
}

std::string fault_in(const std::string& yaml) {
  const test::TemporaryFolder folder;
  folder.write("world.yaml", hall);
  folder.write("map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n");
  return test::config_error(folder / "", [&] {
    ParamsOf<LaserDriveParams> params;
    read_yaml(folder.write("params.yaml", yaml), params);
  });
}

TEST(DriveParams, AreOfAWorldOrOfAMap) {
  const auto expect_fault = [](const std::string& yaml, const std::string& fault) {
    EXPECT_NE(fault_in(yaml).find(fault), std::string::npos) << fault_in(yaml);
  };
  EXPECT_EQ(fault_in("world: world.yaml\nboxes: 3\npeople: 2\n"), "");
  EXPECT_EQ(fault_in("map: map.yaml\ntour_legs: 3\n"), "");
  EXPECT_EQ(fault_in("map: map.yaml\nway_points: [[1, 1], [2, 1]]\n"), "");
  expect_fault("world: world.yaml\nlaser: {noise: 11}\n",
               "noise: 11 is out of range, must be >= 0 and <= 10 m");
  expect_fault("tour_legs: 3\n",
               "world: must be given, or map in its place: a robot drives in one of the two");
  expect_fault("world: world.yaml\nmap: map.yaml\ntour_legs: 3\n",
               "world: must be given, or map in its place: a robot drives in one of the two");
  expect_fault("world: world.yaml\nway_points: [[1, 1], [2, 1]]\n",
               "way_points: must be left out where there is a world, whose file has them");
  expect_fault("map: map.yaml\nway_points: [[1, 1]]\n", "way_points: must be two or more");
  expect_fault("map: map.yaml\n", "tour_legs: must be 1 or more in a map without way_points");
  expect_fault("world: world.yaml\nlidar: {beams: 16}\n",
               "key 'lidar' was removed: a drive with a lidar is the observation source lidar_simulation");
}

}  // namespace
}  // namespace glocal::simulation::planned_drive_test
