#include "sources/sites/office_site.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "glocal/pose2.hpp"
#include "sources/simulation/shapes.hpp"
#include "sources/simulation/world_grid.hpp"
#include "sources/sites/office_plan.hpp"

namespace glocal::office_site_test {
namespace {

using simulation::Position;
using simulation::Shapes;
using simulation::shapes_in_reality;
using simulation::shapes_on_map;
using simulation::World;
using sites::office_site;

bool is_only_on_map(const simulation::Presence& presence) {
  return presence.on_map && !presence.in_reality;
}
bool is_only_in_reality(const simulation::Presence& presence) {
  return !presence.on_map && presence.in_reality;
}

/// All that a laser meets, in words that can be compared.
std::vector<std::array<double, 4>> outlines(const Shapes& shapes) {
  std::vector<std::array<double, 4>> lines;
  for (const simulation::Segment& s : shapes.segments)
    lines.push_back({s.from[0], s.from[1], s.to[0], s.to[1]});
  for (const simulation::Circle& c : shapes.circles)
    lines.push_back({c.centre[0], c.centre[1], c.radius, 0.0});
  return lines;
}

TEST(OfficeSite, IsTheSameForTheSameSeedOnly) {
  const World a = office_site(40.0, 100.0, 7);
  const World b = office_site(40.0, 100.0, 7);
  const World c = office_site(40.0, 100.0, 8);
  EXPECT_EQ(outlines(shapes_in_reality(a)), outlines(shapes_in_reality(b)));
  EXPECT_EQ(outlines(shapes_on_map(a)), outlines(shapes_on_map(b)));
  EXPECT_EQ(a.way_points, b.way_points);
  EXPECT_NE(outlines(shapes_on_map(a)), outlines(shapes_on_map(c)));
  EXPECT_NE(a.way_points, c.way_points);
}

/// Distance from a place to a straight way.
double distance_to_way(const Position& place, const Position& from, const Position& to) {
  const double length = simulation::distance(from, to);
  const Position along{(to[0] - from[0]) / length, (to[1] - from[1]) / length};
  const double share =
      std::clamp((place[0] - from[0]) * along[0] + (place[1] - from[1]) * along[1], 0.0, length);
  return std::hypot(place[0] - from[0] - share * along[0], place[1] - from[1] - share * along[1]);
}

TEST(OfficeSite, TheDriveIsFree) {
  for (const double side : {20.0, 33.3, 60.0, 117.0}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const World world = office_site(side, 5.0 * side, seed);
      const Shapes reality = shapes_in_reality(world);
      double length = 0.0;
      for (std::size_t i = 1; i < world.way_points.size(); ++i) {
        const Position& from = world.way_points[i - 1];
        const Position& to = world.way_points[i];
        length += simulation::distance(from, to);
        ASSERT_TRUE(simulation::is_free_way(reality, from, to))
            << side << " m, seed " << seed << ", way " << i;
        for (const simulation::Segment& s : reality.segments) {
          for (const Position& end : {s.from, s.to}) ASSERT_GT(distance_to_way(end, from, to), 0.2);
        }
        for (const simulation::Circle& c : reality.circles)
          ASSERT_GT(distance_to_way(c.centre, from, to), c.radius + 0.2);
        ASSERT_GT(simulation::clearance(reality, to), 0.2);
      }
      EXPECT_NEAR(length, 5.0 * side, 1e-6);
    }
  }
}

TEST(OfficeSite, TheDriveIsWhereTheMapIsFree) {
  const World world = office_site(60.0, 400.0, 4);
  const OccupancyGrid map = simulation::plan_of(world, 0.05, "");
  // The map is freed from one place: all that the drive comes to is connected to it.
  for (const Position& place : world.way_points) EXPECT_EQ(map.at(place[0], place[1]), Cell::free);
}

TEST(OfficeSite, TheDriveComesAllOverTheSite) {
  const World world = office_site(200.0, 1000.0, 1);
  std::set<std::pair<int, int>> quarters;
  for (const Position& place : world.way_points)
    quarters.emplace(static_cast<int>(place[0] / 50.0), static_cast<int>(place[1] / 50.0));
  EXPECT_GE(quarters.size(), 10U) << "of 16 parts";
}

TEST(OfficeSite, SomeThingsHaveChangedSinceTheMapWasMade) {
  const World world = office_site(100.0, 500.0, 1);
  double changed = 0.0, all = 0.0;
  const auto count = [&](const auto& things) {
    for (const auto& thing : things) {
      if (!thing.presence.on_map) continue;
      ++all;
      if (is_only_on_map(thing.presence)) ++changed;
    }
  };
  count(world.circles);
  EXPECT_GT(changed / all, 0.5) << "chairs";
  EXPECT_LT(changed / all, 0.85);
  const auto is_new = [](const auto& thing) { return is_only_in_reality(thing.presence); };
  EXPECT_GT(std::count_if(world.rectangles.begin(), world.rectangles.end(), is_new), 100);
  EXPECT_GT(std::count_if(world.walls.begin(), world.walls.end(), is_new), 50) << "doors";
}

TEST(OfficeSite, WhatIsNewIsNotOnTheMap) {
  const World world = office_site(60.0, 100.0, 5);
  const OccupancyGrid map = simulation::plan_of(world, 0.05, "");
  int on_free_cells = 0;
  for (const simulation::Rectangle& box : world.rectangles) {
    if (!is_only_in_reality(box.presence)) continue;
    // Within its four sides, as it may stand less than a cell away from a wall. Of rooms that were shut
    // nothing is known.
    const double angle = radians(box.angle_deg);
    for (const double side : {-0.3, 0.3}) {
      const double along = side * box.size[0];
      const double across = side * box.size[1];
      const Cell end =
          map.at(box.centre[0] + along * std::cos(angle), box.centre[1] + along * std::sin(angle));
      const Cell flank =
          map.at(box.centre[0] - across * std::sin(angle), box.centre[1] + across * std::cos(angle));
      EXPECT_NE(end, Cell::occupied);
      EXPECT_NE(flank, Cell::occupied);
      if (end == Cell::free && flank == Cell::free) ++on_free_cells;
    }
  }
  EXPECT_GT(on_free_cells, 50);
}

TEST(OfficeSite, RaysMeetWhatIsThereInReality) {
  const World world = office_site(60.0, 300.0, 6);
  const Shapes reality = shapes_in_reality(world);
  const Shapes mapped = shapes_on_map(world);
  int rays = 0, shorter = 0, longer = 0;
  for (const Position& place : world.way_points) {
    for (int degree = 0; degree < 360; degree += 3) {
      const Position direction{std::cos(radians(degree)), std::sin(radians(degree))};
      const double real = simulation::ray_distance(reality, place, direction);
      const double expected = simulation::ray_distance(mapped, place, direction);
      ++rays;
      if (real < expected - 0.2) ++shorter;
      if (real > expected + 0.2) ++longer;
    }
  }
  // The larger part of what is seen are walls, which stay.
  EXPECT_GT(shorter, 0.03 * rays);
  EXPECT_LT(shorter, 0.25 * rays);
  EXPECT_GT(longer, 0.01 * rays);
  EXPECT_LT(longer, 0.25 * rays);
}

TEST(OfficeSite, NothingIsKnownOfRoomsThatWereShut) {
  const World world = office_site(100.0, 500.0, 2);
  const OccupancyGrid map = simulation::plan_of(world, 0.05, "");
  std::map<Cell, int> cells;
  for (const Cell cell : map.cells) ++cells[cell];
  const double all = static_cast<double>(map.cells.size());
  EXPECT_GT(cells[Cell::unknown] / all, 0.1);
  EXPECT_LT(cells[Cell::unknown] / all, 0.4);
}

TEST(OfficePlan, RoomsFillTheRowsWithoutOverlapping) {
  std::vector<double> sides{150.0, 500.0};
  for (double side = 20.0; side < 80.0; side += 0.3) sides.push_back(side);
  for (const double side : sides) {
    const sites::OfficePlan plan = sites::office_plan(side, Rng(3));
    ASSERT_GE(plan.cross_corridors.size(), 1U);
    ASSERT_EQ(plan.rows.size(), 2 * plan.corridors.size());
    double rooms = 0.0, rows = 0.0;
    for (const sites::Room& room : plan.rooms) rooms += room.width * room.depth;
    for (const sites::Span& row : plan.rows) {
      for (const sites::Span& wing : plan.wings) rows += row.length() * wing.length();
    }
    EXPECT_NEAR(rooms, rows, 1e-6 * rows) << side;
    double along = 0.0, across = 0.0;
    for (const auto* spans : {&plan.wings, &plan.cross_corridors})
      for (const sites::Span& span : *spans) along += span.length();
    for (const auto* spans : {&plan.rows, &plan.corridors})
      for (const sites::Span& span : *spans) across += span.length();
    EXPECT_NEAR(along, plan.x.length(), 1e-6);
    EXPECT_NEAR(across, plan.y.length(), 1e-6);
    EXPECT_GT(plan.x.length(), side - 1.2) << side;
    EXPECT_LT(plan.x.to, side);
  }
}

TEST(OfficePlan, ManyRoomsHaveTheSameWalls) {
  const sites::OfficePlan plan = sites::office_plan(100.0, Rng(1));
  std::map<std::pair<long, long>, int> sizes;
  for (const sites::Room& room : plan.rooms)
    ++sizes[{std::lround(100.0 * room.width), std::lround(100.0 * room.depth)}];
  int most = 0;
  for (const auto& [size, n] : sizes) most = std::max(most, n);
  EXPECT_GT(most, 20);
  EXPECT_GT(sizes.size(), 8U);
}

}  // namespace
}  // namespace glocal::office_site_test
