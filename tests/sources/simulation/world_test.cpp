#include "sources/simulation/world.hpp"

#include <gtest/gtest.h>

#include "files.hpp"

namespace glocal::simulation::world_test {
namespace {

constexpr const char* room =
    "size: [6, 4]\n"
    "walls:\n"
    "  - {points: [[0, 0], [6, 0], [6, 4], [0, 4]], closed: true}\n"
    "free_from: [[1, 1]]\n"
    "way_points: [[1, 1], [5, 1]]\n";

World read(const std::string& yaml) {
  const test::TemporaryFolder folder;
  return read_world(folder.write("world.yaml", yaml));
}

std::string fault_of(const std::string& yaml) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("world.yaml", yaml);
  return test::config_error(file.parent_path(), [&] { static_cast<void>(read_world(file)); });
}

TEST(World, KeepsMapAndRealityApart) {
  const World world = read(std::string(room) +
                           "rectangles:\n"
                           "  - {centre: [3, 3], size: [1, 0.5], in_reality: false}\n"
                           "circles:\n"
                           "  - {centre: [2, 2], radius: 0.5, on_map: false}\n");
  EXPECT_EQ(shapes_on_map(world).segments.size(), 8U);
  EXPECT_TRUE(shapes_on_map(world).circles.empty());
  EXPECT_EQ(shapes_in_reality(world).segments.size(), 4U);
  EXPECT_EQ(shapes_in_reality(world).circles.size(), 1U);
}

TEST(World, TurnsRectangles) {
  const World world =
      read(std::string(room) + "rectangles: [{centre: [3, 3], size: [1, 0.5], angle_deg: 90}]\n");
  const Segment first = shapes_on_map(world).segments[4];
  EXPECT_NEAR(first.from[0], 3.25, 1e-12);
  EXPECT_NEAR(first.from[1], 2.5, 1e-12);
  EXPECT_NEAR(first.to[0], 3.25, 1e-12);
  EXPECT_NEAR(first.to[1], 3.5, 1e-12);
}

TEST(World, PeopleWalkToAndFro) {
  const World world = read(std::string(room) + "people: [{points: [[1, 1], [3, 1], [3, 2]], speed: 0.5}]\n");
  const auto at = [&](double time) { return people_at(world, time).front().centre; };
  EXPECT_EQ(at(0.0), (Position{1, 1}));
  EXPECT_EQ(at(2.0), (Position{2, 1}));
  EXPECT_EQ(at(5.0), (Position{3, 1.5}));
  EXPECT_EQ(at(7.0), (Position{3, 1.5})) << "on the way back";
  EXPECT_EQ(at(14.0), (Position{2, 1})) << "on the way there again";
}

TEST(World, RefusesAWayThroughAWall) {
  EXPECT_EQ(fault_of(std::string(room) + "rectangles: [{centre: [3, 1], size: [1, 1]}]\n"),
            "world.yaml: error: way_points[1]: the way from [1, 1] to [5, 1] meets a wall or thing, or has "
            "no length; move the way point or the thing");
  EXPECT_EQ(fault_of(std::string(room) + "rectangles: [{centre: [3, 1], size: [1, 1], in_reality: false}]\n"),
            "");
}

TEST(World, NamesThePlaceOfAFault) {
  const std::string faults = fault_of(
      "size: [6, -4]\n"
      "wals: []\n"
      "circles: [{centre: [1], radius: 0}]\n"
      "free_from: [[1, 1]]\n"
      "way_points: [[1, 1], [1, nan]]\n");
  for (const char* place :
       {"world.yaml:1:11: error: size", "world.yaml:2:1: error: unknown key 'wals'",
        "world.yaml:3:20: error: circles[0]: centre", "world.yaml:3:33: error: circles[0]: radius",
        "world.yaml:5:26: error: way_points"}) {
    EXPECT_NE(faults.find(place), std::string::npos) << place << "\n" << faults;
  }
  EXPECT_NE(fault_of("size: [6, 4]\nfree_from: [[1, 9]]\nway_points: [[1, 1], [2, 1]]\n")
                .find("must lie within size"),
            std::string::npos);
}

TEST(World, MoreThanCanBeCheckedIsRefused) {
  const auto many = [](int n) {
    std::string points;
    for (int i = 0; i < n; ++i) points += i % 2 == 0 ? "[1, 1], " : "[5, 1], ";
    return points;
  };
  EXPECT_EQ(fault_of("size: [6, 4]\nfree_from: [[1, 1]]\nway_points: [" + many(40000) + "]\n"),
            "world.yaml:3:13: error: way_points: expected 2 to 10000 items, got 40000");
  EXPECT_EQ(fault_of(std::string(room) + "people: []\ncircles: [{centre: [3, 3], radius: 0.1}]\n"), "");
  EXPECT_EQ(fault_of("size: [6, 4]\nwalls: [{points: [" + many(10001) +
                     "]}]\nfree_from: [[1, 1]]\nway_points: [[1, 2], [5, 2]]\n"),
            "world.yaml:2:8: error: walls: must have at most 10000 corners, together with the rectangles and "
            "circles");
}

}  // namespace
}  // namespace glocal::simulation::world_test
