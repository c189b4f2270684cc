#include "sources/planned_drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glocal/yaml.hpp"
#include "sources/plan.hpp"
#include "sources/simulation.hpp"
#include "sources/world_grid.hpp"

namespace glocal::planned_drive_test {
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

DriveParams params_in(const test::Plan& plan) {
  DriveParams params;
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
  DriveParams params = params_in(plan);
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

TEST(PlannedDrive, GoesOnToWhereItWasGoing) {
  const test::Plan plan(floor_plan);
  DriveParams params = params_in(plan);
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
  DriveParams params = params_in(plan);
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
  DriveParams params = params_in(plan);
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
  DriveParams params;
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
  DriveParams params;
  params.world = test::file_path(folder.write("world.yaml", hall));
  params.lidar.beams = 8;
  params.lidar.noise = params.lidar.outliers = params.lidar.tilt_deg = 0.0;
  params.boxes = 10;
  const Shapes boxes = [&] {
    World world = planned_drive(params, {.seed = 1}).world;
    world.walls.clear();
    return shapes_in_reality(world);
  }();
  const auto source = Simulation::make(params, {.seed = 1});
  std::size_t on_boxes = 0;
  while (const auto sample = source->next()) {
    const Scan& scan = sample->observation.scan;
    for (std::size_t i = 0; i < scan.hits.size(); ++i) {
      const Vector3 hit = *sample->map_from_robot * Vector3{scan.hits.x[i], scan.hits.y[i], scan.hits.z[i]};
      on_boxes += hit.z > 0.05 && clearance(boxes, {hit.x, hit.y}) < 1e-4 ? 1U : 0U;
    }
  }
  EXPECT_GT(on_boxes, 500U);
}

TEST(PlannedDrive, RefusesBoxesInACloud) {
  const test::TemporaryFolder folder;
  folder.write("cloud.pcd", "");
  DriveParams params;
  params.world = test::file_path(folder.write("world.yaml", std::string(hall) + "cloud: cloud.pcd\n"));
  params.people = 1;
  EXPECT_EQ(
      test::config_error(params.world.resolved.parent_path(),
                         [&] { static_cast<void>(planned_drive(params, {})); }),
      "world.yaml: error: cloud: nobody knows where it is free within a cloud; leave out boxes and people, "
      "or list them in the file of the world");
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
    ParamsOf<DriveParams> params;
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
  expect_fault("tour_legs: 3\n",
               "world: must be given, or map in its place: a robot drives in one of the two");
  expect_fault("world: world.yaml\nmap: map.yaml\ntour_legs: 3\n",
               "world: must be given, or map in its place: a robot drives in one of the two");
  expect_fault("world: world.yaml\nway_points: [[1, 1], [2, 1]]\n",
               "way_points: must be left out where there is a world, whose file has them");
  expect_fault("map: map.yaml\nway_points: [[1, 1]]\n", "way_points: must be two or more");
  expect_fault("map: map.yaml\n", "tour_legs: must be 1 or more in a map without way_points");
  expect_fault("map: map.yaml\ntour_legs: 3\nlidar: {beams: 16}\n",
               "map: must be left out where there is a lidar");
}

}  // namespace
}  // namespace glocal::planned_drive_test
