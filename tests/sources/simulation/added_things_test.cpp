#include "sources/simulation/added_things.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "files.hpp"
#include "sources/simulation/clear_cells.hpp"

namespace glocal::simulation::added_things_test {
namespace {

/// A hall of 12 m x 8 m with cells of 0.1 m, turned, with two walls and an unknown part.
class Hall : public testing::Test {
 protected:
  Hall() {
    fill(0, 120, 38, 41, Cell::occupied);
    fill(50, 60, 38, 41, Cell::free);
    fill(90, 93, 50, 80, Cell::occupied);
    fill(0, 30, 60, 80, Cell::unknown);
  }

  void fill(int left, int right, int low, int high, Cell kind) {
    for (int row = low; row < high; ++row) {
      for (int column = left; column < right; ++column) grid_.cell(column, row) = kind;
    }
  }

  [[nodiscard]] ClearRegion region() const { return ClearRegion::largest(grid_, clear_cells(grid_, 0.3)); }

  [[nodiscard]] std::vector<Rectangle> boxes(int count, std::uint64_t seed = 1) const {
    return drawn_boxes(count, grid_, region(), ways_, 0.3, Rng(seed), "map.yaml");
  }

  /// Places in and around a box, 2 cm apart.
  static std::vector<Position> places_in(const Rectangle& box) {
    const Pose2 map_from_box{box.centre[0], box.centre[1], radians(box.angle_deg)};
    std::vector<Position> places;
    for (int i = 0; i <= 50; ++i) {
      for (int k = 0; k <= 50; ++k) {
        const Pose2 p =
            map_from_box * Pose2{box.size[0] * (i / 50.0 - 0.5), box.size[1] * (k / 50.0 - 0.5), 0.0};
        places.push_back({p.x, p.y});
      }
    }
    return places;
  }

  OccupancyGrid grid_{{2.0, 1.0, 0.3}, 0.1, 120, 80, PackedCells(std::size_t{120} * 80, Cell::free)};
  std::vector<std::vector<Position>> ways_;
};

double distance_to_way(const Position& place, const std::vector<Position>& way) {
  double nearest = 1e9;
  for (std::size_t i = 1; i < way.size(); ++i) {
    for (int k = 0; k <= 200; ++k)
      nearest = std::min(nearest, distance(place, between(way[i - 1], way[i], k / 200.0)));
  }
  return nearest;
}

TEST_F(Hall, HasAsManyBoxesAsAskedForOnFreeSpaceOffTheWays) {
  const ClearRegion here = region();
  Rng rng(5);
  for (int i = 0; i < 3; ++i) {
    const Position from = here.draw(rng);
    std::vector<Position> way = here.way(from, here.draw(rng));
    way.insert(way.begin(), from);
    ways_.push_back(way);
  }
  const std::vector<Rectangle> drawn = boxes(15);
  ASSERT_EQ(drawn.size(), 15U);
  std::vector<int> box_on_cell(grid_.cells.size(), -1);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Rectangle& box = drawn[i];
    EXPECT_FALSE(box.presence.on_map);
    EXPECT_TRUE(box.presence.in_reality);
    for (const double side : box.size) {
      EXPECT_GE(side, 0.3);
      EXPECT_LE(side, 1.0);
    }
    EXPECT_GE(box.height, 0.5);
    EXPECT_LE(box.height, 1.5);
    for (const Position& place : places_in(box)) {
      ASSERT_EQ(grid_.at(place[0], place[1]), Cell::free);
      int& owner = box_on_cell[*cell_under(place, grid_)];
      ASSERT_TRUE(owner == -1 || owner == static_cast<int>(i)) << "on top of each other";
      owner = static_cast<int>(i);
      // Ways are looked at every few centimetres.
      for (const std::vector<Position>& way : ways_) ASSERT_GE(distance_to_way(place, way), 0.3);
    }
  }
}

TEST_F(Hall, DependsOnItsSeedOnly) {
  const auto centres = [&](std::uint64_t seed) {
    std::vector<std::vector<double>> all;
    for (const Rectangle& box : boxes(10, seed)) all.push_back(box.centre);
    return all;
  };
  EXPECT_EQ(centres(1), centres(1));
  EXPECT_NE(centres(1), centres(2));
}

TEST_F(Hall, SaysThatItIsFull) {
  fill(0, 120, 0, 80, Cell::unknown);
  fill(10, 40, 10, 40, Cell::free);
  const std::string message = test::config_error("", [&] { static_cast<void>(boxes(1000)); });
  EXPECT_NE(message.find("map.yaml: error: boxes: room was found for "), std::string::npos) << message;
  EXPECT_NE(
      message.find(" of 1000 boxes on free space off the ways of robot and people; lower boxes, people or "
                   "clearance"),
      std::string::npos)
      << message;
}

TEST_F(Hall, HasPeopleWhoWalkInClearSpaceOnly) {
  const ClearRegion here = region();
  const std::vector<Walker> people = drawn_people(12, here, Rng(2));
  ASSERT_EQ(people.size(), 12U);
  for (const Walker& walker : people) {
    EXPECT_GE(walker.speed, 0.4);
    EXPECT_LE(walker.speed, 1.2);
    EXPECT_GE(walker.points.size(), 2U);
    for (std::size_t i = 1; i < walker.points.size(); ++i) {
      for (int k = 0; k <= 50; ++k) {
        const Position place = between(walker.points[i - 1], walker.points[i], k / 50.0);
        ASSERT_EQ(grid_.at(place[0], place[1]), Cell::free);
      }
    }
  }
  EXPECT_NE(drawn_people(1, here, Rng(3))[0].points, people[0].points);
  EXPECT_EQ(drawn_people(1, here, Rng(2))[0].points, people[0].points);
}

}  // namespace
}  // namespace glocal::simulation::added_things_test
