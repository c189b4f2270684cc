#include "glocal/clearance_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "glocal/rng.hpp"
#include "instruction_sets.hpp"
#include "points.hpp"

namespace glocal::clearance_grid_test {
namespace {

TEST(ClearanceGrid, BlocksWhatLookingAtEveryHalfCellWouldBlock) {
  Rng rng(9);
  OccupancyGrid grid{{1.0, -2.0, 0.4}, 0.1, 60, 50, PackedCells(3000, Cell::free)};
  for (auto&& cell : grid.cells) cell = rng.uniform() < 0.01 ? Cell::occupied : Cell::free;
  const ClearanceGrid clearance(grid);
  int blocked = 0;
  int differ = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto point = [&] {
      return Point{static_cast<float>(rng.uniform(-2.0, 7.0)), static_cast<float>(rng.uniform(-3.0, 6.0)),
                   0.0F};
    };
    const Point from = point();
    const Point to = point();
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    bool expected = false;
    for (double t = 0.05; t <= length - 0.3; t += 0.05) {
      expected = expected || grid.at(from.x + t * (to.x - from.x) / length,
                                     from.y + t * (to.y - from.y) / length) == Cell::occupied;
    }
    blocked += expected ? 1 : 0;
    differ += expected != clearance.is_blocked(from, to, 0.3) ? 1 : 0;
  }
  EXPECT_GT(blocked, 500);
  // Steps that skip free cells look at other places of those behind: rays that touch a corner may differ.
  EXPECT_LT(differ, 60);
}

TEST(ClearanceGrid, TheFirstOccupiedCellIsWhereSmallStepsWouldMeetIt) {
  Rng rng(11);
  OccupancyGrid grid{{-1.0, 2.0, -0.3}, 0.1, 70, 60, PackedCells(4200, Cell::free)};
  for (auto&& cell : grid.cells) cell = rng.uniform() < 0.02 ? Cell::occupied : Cell::free;
  const ClearanceGrid clearance(grid);
  int met = 0;
  int far_off = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto row = static_cast<int>(rng.below(60));
    const auto column = static_cast<int>(rng.below(70));
    const Pose2 centre = grid.centre(column, row);
    const double angle = rng.uniform(-3.14, 3.14);
    const Point from{static_cast<float>(centre.x), static_cast<float>(centre.y), 0.0F};
    const Point to{static_cast<float>(centre.x + 20.0 * std::cos(angle)),
                   static_cast<float>(centre.y + 20.0 * std::sin(angle)), 0.0F};
    double expected = 20.0;
    for (double t = 0.05; t < expected; t += 0.002) {
      if (grid.at(from.x + t * std::cos(angle), from.y + t * std::sin(angle)) == Cell::occupied) expected = t;
    }
    const double found = clearance.first_occupied(from, to, 0.0).value_or(20.0);
    // Never before it, and within a step after it, unless only a corner was touched.
    EXPECT_GT(found, expected - 0.003);
    met += expected < 20.0 ? 1 : 0;
    far_off += found > expected + 0.055 ? 1 : 0;
  }
  EXPECT_GT(met, 300);
  EXPECT_LT(far_off, met / 10);
}

TEST(ClearanceGrid, RaysFromFarBeyondTheGridMeetItsWallOrNothing) {
  OccupancyGrid grid{{}, 0.001, 10, 10, PackedCells(100, Cell::free)};
  for (int row = 0; row < 10; ++row) grid.cells.fill(grid.index(4, row), 1, Cell::occupied);
  const ClearanceGrid clearance(grid);
  const Point from{-1.0F, 0.005F, 0.0F};
  const auto wall = clearance.first_occupied(from, {1.0F, 0.005F, 0.0F}, 0.0);
  ASSERT_TRUE(wall.has_value());
  EXPECT_NEAR(*wall, 1.004, 0.001);
  // 10 km are ten million cells, of which a float knows no halves.
  EXPECT_FALSE(clearance.first_occupied(from, {-10000.0F, 0.005F, 0.0F}, 0.0).has_value());
  EXPECT_FALSE(clearance.first_occupied({-9000.0F, 0.0F, 0.0F}, {9000.0F, 0.0F, 0.0F}, 0.0).has_value());
  std::vector<std::uint8_t> blocked;
  Points ends;
  for (const float x : {1.0F, -10000.0F}) ends.push_back({x, 0.005F, 0.0F});
  clearance.find_blocked(from, ends, Transform(Pose2{}), 0.0, blocked);
  EXPECT_EQ(blocked, (std::vector<std::uint8_t>{1, 0}));
}

TEST(ClearanceGrid, ManyBeamsAreBlockedAsEachByItself) {
  Rng rng(10);
  OccupancyGrid grid{{1.0, -2.0, 0.4}, 0.1, 60, 50, PackedCells(3000, Cell::free)};
  for (auto cell : grid.cells) cell = rng.uniform() < 0.02 ? Cell::occupied : Cell::free;
  grid.cells[2999] = Cell::occupied;
  const ClearanceGrid clearance(grid);
  const Transform map_from_ends(Pose2{0.5, 1.0, 0.7});
  Points ends;
  for (int i = 0; i < 1003; ++i)
    ends.push_back(
        {static_cast<float>(rng.uniform(-9.0, 9.0)), static_cast<float>(rng.uniform(-9.0, 9.0)), 0.0F});
  ends.set(5, {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F});
  // Within the grid, beyond each of its sides, and far away.
  const std::vector<Point> places{{2.0F, 1.0F, 0.0F}, {-3.0F, 0.0F, 0.0F}, {9.0F, 2.0F, 0.0F},
                                  {2.0F, 8.0F, 0.0F}, {3.0F, -6.0F, 0.0F}, {-400.0F, -300.0F, 0.0F}};
  for (const Point& from : places) {
    std::vector<std::uint8_t> expected;
    for (std::size_t i = 0; i < ends.size(); ++i)
      expected.push_back(clearance.is_blocked(from, map_from_ends(ends[i]), 0.3) ? 1 : 0);
    test::with_every_instruction_set([&] {
      std::vector<std::uint8_t> blocked(7, 1);
      clearance.find_blocked(from, ends, map_from_ends, 0.3, blocked);
      EXPECT_EQ(blocked, expected) << from.x << ' ' << from.y;
    });
    EXPECT_GT(std::count(expected.begin(), expected.end(), 1), 100) << from.x << ' ' << from.y;
  }
}

TEST(ClearanceGrid, InTheMiddleOfAGridThatIsMadeInPiecesAWallIsWhereItIs) {
  // Walls at distances that are told over the border of a piece, and farther than a number tells.
  OccupancyGrid grid{{}, 1.0, 6, 3001, PackedCells(std::size_t{6} * 3001, Cell::free)};
  for (const int row : {0, 1020, 1500, 1503, 3000}) {
    for (int column = 0; column < 6; ++column) grid.cell(column, row) = Cell::occupied;
  }
  for (const int threads : {1, 2, 3}) {
    const ClearanceGrid clearance(grid, threads);
    EXPECT_LT(clearance.memory_bytes(), grid.cells.size());
    for (int row = 1; row < 3000; row += 7) {
      const float y = static_cast<float>(row) + 0.25F;
      const int next = row <= 1020 ? 1020 : row <= 1500 ? 1500 : row <= 1503 ? 1503 : 3000;
      const double to_wall = next - double{y};
      const auto found = clearance.first_occupied({2.5F, y, 0.0F}, {2.5F, 3200.0F, 0.0F}, 0.0);
      ASSERT_TRUE(found.has_value()) << row;
      if (row == next) continue;
      EXPECT_GE(*found, to_wall) << row;
      EXPECT_LE(*found, to_wall + 1.0) << row;
    }
  }
}

TEST(ClearanceGrid, AMapWithoutAGridBlocksNothing) {
  const ClearanceGrid none(OccupancyGrid{});
  EXPECT_FALSE(none.is_blocked({}, {5.0F, 0.0F, 0.0F}, 0.3));
  const Points ends = test::points_of({{5.0F, 0.0F, 0.0F}});
  std::vector<std::uint8_t> blocked;
  none.find_blocked({}, ends, Transform(Pose2{}), 0.3, blocked);
  EXPECT_EQ(blocked, std::vector<std::uint8_t>{0});
}

}  // namespace
}  // namespace glocal::clearance_grid_test
