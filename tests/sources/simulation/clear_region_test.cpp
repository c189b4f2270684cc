#include "sources/simulation/clear_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "sources/plan.hpp"
#include "sources/simulation/clear_cells.hpp"

namespace glocal::simulation::clear_region_test {
namespace {

using test::Plan;

/// Cells of 0.5 m: rooms of 3 and 5 cells, and one of 2 x 2.
const std::vector<std::string> rooms{
    "#########",  //
    "#...#..##",  //
    "#####..##",  //
    "#.....###",  //
    "#########",
};

double length_of(Position from, const std::vector<Position>& way) {
  double length = 0.0;
  for (const Position& place : way) {
    length += distance(from, place);
    from = place;
  }
  return length;
}

ClearRegion largest(const OccupancyGrid& grid, double clearance) {
  return ClearRegion::largest(grid, clear_cells(grid, clearance));
}

TEST(ClearRegion, IsTheLargestOrTheOneAroundAPlace) {
  const OccupancyGrid grid = Plan(rooms).grid();
  // The room at the top right and the one at the bottom share a side of a cell.
  const ClearRegion region = largest(grid, 0.0);
  EXPECT_EQ(region.size(), 9U);
  EXPECT_TRUE(region.holds({0.75, 0.75}));
  EXPECT_TRUE(region.holds({3.25, 1.75}));
  EXPECT_FALSE(region.holds({0.75, 1.75}));
  EXPECT_FALSE(region.holds({-0.1, 0.75}));
  EXPECT_FALSE(region.holds({100.0, 0.75}));
  const auto around = [&](const Position& place) {
    return ClearRegion::around(place, grid, clear_cells(grid, 0.0)).size();
  };
  EXPECT_EQ(around({0.75, 1.75}), 3U);
  EXPECT_EQ(around({3.25, 1.25}), 9U);
  EXPECT_EQ(around({0.25, 0.25}), 0U) << "a wall";
  EXPECT_EQ(around({-1.0, 0.0}), 0U) << "off the map";
  EXPECT_EQ(largest(grid, 1.0).size(), 0U);
}

TEST(ClearRegion, DoesNotReachOverCorners) {
  EXPECT_EQ(largest(Plan({"..#", "..#", "##."}).grid(), 0.0).size(), 4U);
}

TEST(ClearRegion, DrawsEachOfItsCells) {
  const ClearRegion region = largest(Plan(rooms, "[10, 20, 0]").grid(), 0.0);
  Rng rng(1);
  std::set<Position> places;
  for (int i = 0; i < 200; ++i) {
    const Position place = region.draw(rng);
    EXPECT_TRUE(region.holds(place));
    places.insert(place);
  }
  EXPECT_EQ(places.size(), 9U);
  EXPECT_EQ(*places.begin(), (Position{10.75, 20.75}));
}

TEST(ClearRegion, GoesStraightWhereItCan) {
  const ClearRegion region = largest(Plan(rooms).grid(), 0.0);
  EXPECT_EQ(region.way({0.6, 0.7}, {2.9, 0.9}), (std::vector<Position>{{2.9, 0.9}}));
  EXPECT_EQ(region.way({0.6, 0.7}, {0.6, 0.7}), (std::vector<Position>{{0.6, 0.7}}));
}

TEST(ClearRegion, GoesAroundCorners) {
  // A wall from the left, one cell thick: the way from below it to above it leads around its end.
  const OccupancyGrid grid = Plan({"......", "####..", "......"}).grid();
  const ClearRegion region = largest(grid, 0.0);
  const Position from{0.25, 0.25};
  const Position to{0.25, 1.25};
  const std::vector<Position> way = region.way(from, to);
  EXPECT_EQ(way.back(), to);
  // At least around the corners (2, 0.5) and (2, 1), at most over the centres of the cells.
  const double around_corners = 2.0 * std::hypot(1.75, 0.25) + 0.5;
  EXPECT_GE(length_of(from, way), around_corners);
  EXPECT_LE(length_of(from, way), 2.0 * 2.0 + 1.0);
}

/// Random rooms, with walls and clutter.
OccupancyGrid random_grid(std::uint64_t seed) {
  OccupancyGrid grid{{3.0, -2.0, 0.4}, 0.1, 80, 60, PackedCells(std::size_t{80} * 60, Cell::free)};
  Rng rng(seed);
  for (int i = 0; i < 25; ++i) {
    const int column = static_cast<int>(rng.below(70));
    const int row = static_cast<int>(rng.below(50));
    const int width = 1 + static_cast<int>(rng.below(10));
    const int height = 1 + static_cast<int>(rng.below(10));
    const Cell kind = i % 2 == 0 ? Cell::occupied : Cell::unknown;
    for (int r = row; r < row + height; ++r) {
      for (int c = column; c < column + width; ++c) grid.cell(c, r) = kind;
    }
  }
  return grid;
}

/// Length of a shortest way over the centres of clear cells (m) by trying all steps until none helps.
double shortest(const OccupancyGrid& grid, const std::vector<char>& is_clear, std::size_t from,
                std::size_t to) {
  std::vector<double> lengths(grid.cells.size(), std::numeric_limits<double>::infinity());
  lengths[from] = 0.0;
  const auto clear = [&](int c, int r) {
    return c >= 0 && r >= 0 && c < grid.width && r < grid.height && is_clear[grid.index(c, r)] != 0;
  };
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        if (!clear(column, row)) continue;
        for (int r = row - 1; r <= row + 1; ++r) {
          for (int c = column - 1; c <= column + 1; ++c) {
            if (!clear(c, r) || !clear(column, r) || !clear(c, row)) continue;
            const double length = lengths[grid.index(c, r)] + 0.1 * std::hypot(c - column, r - row);
            if (length >= lengths[grid.index(column, row)] - 1e-9) continue;
            lengths[grid.index(column, row)] = length;
            has_changed = true;
          }
        }
      }
    }
  }
  return lengths[to];
}

/// Distance from a place to the nearest cell that is not free, or off the grid, m.
double clearance_at(const OccupancyGrid& grid, const Position& place) {
  const Pose2 p = inverse(grid.map_from_grid) * Pose2{place[0], place[1], 0.0};
  double nearest = std::min(std::min(p.x, grid.width * grid.resolution - p.x),
                            std::min(p.y, grid.height * grid.resolution - p.y));
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

TEST(ClearRegion, WaysAreShortAndStayClear) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const OccupancyGrid grid = random_grid(seed);
    const double clearance = 0.25;
    const std::vector<char> is_clear = clear_cells(grid, clearance);
    const ClearRegion region = largest(grid, clearance);
    ASSERT_GT(region.size(), 300U);
    Rng rng(seed);
    for (int i = 0; i < 4; ++i) {
      const Position from = region.draw(rng);
      const Position to = region.draw(rng);
      const std::vector<Position> way = region.way(from, to);
      EXPECT_EQ(way.back(), to);
      EXPECT_EQ(way, region.way(from, to));
      const double on_cells = shortest(grid, is_clear, *cell_under(from, grid), *cell_under(to, grid));
      EXPECT_LE(length_of(from, way), 1.002 * on_cells + 1e-9);
      EXPECT_GE(length_of(from, way), distance(from, to) - 1e-9);
      Position at = from;
      for (const Position& place : way) {
        for (int k = 0; k <= 20; ++k)
          ASSERT_GE(clearance_at(grid, between(at, place, k / 20.0)), clearance - 1e-9);
        at = place;
      }
    }
  }
}

TEST(ClearRegion, WaysThroughOpenSpaceHaveNoCornersOfTheGrid) {
  // Around one pillar in a hall, at angles that steps from cell to cell do not have.
  OccupancyGrid grid{{}, 0.1, 100, 60, PackedCells(6000, Cell::free)};
  for (int row = 25; row < 35; ++row) {
    for (int column = 45; column < 55; ++column) grid.cell(column, row) = Cell::occupied;
  }
  const ClearRegion region = largest(grid, 0.3);
  const Position from{0.75, 2.65};
  const Position to{9.25, 3.15};
  const std::vector<Position> way = region.way(from, to);
  // Over the pillar's corners, 0.3 m away: at (4.5, 2.5) and (5.5, 2.5) at least the way around them.
  const double around_corners = distance(from, {4.5, 2.2}) + 1.0 + distance({5.5, 2.2}, to);
  EXPECT_LT(length_of(from, way), 1.01 * around_corners);
  EXPECT_LE(way.size(), 5U);
}

}  // namespace
}  // namespace glocal::simulation::clear_region_test
