#include "glocal/occupancy_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "glocal/rng.hpp"
#include "instruction_sets.hpp"

namespace glocal::occupancy_grid_test {
namespace {

constexpr double quarter = std::numbers::pi / 2.0;

/// Two columns and one row of half a metre, from (1, 2) on, with the columns along the map's y.
OccupancyGrid two_cells() {
  return {{1.0, 2.0, quarter}, 0.5, 2, 1, {Cell::occupied, Cell::free}};
}

TEST(PackedCells, AreThoseOfAListOneByOne) {
  Rng rng(3);
  std::vector<Cell> expected(1000, Cell::free);
  PackedCells cells(1000, Cell::free);
  for (int i = 0; i < 300; ++i) {
    const auto kind = static_cast<Cell>(rng.below(3));
    const std::size_t begin = rng.below(1000);
    const std::size_t n = std::min<std::size_t>(rng.below(70), 1000 - begin);
    std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(begin), n, kind);
    cells.fill(begin, n, kind);
    const std::size_t one = rng.below(1000);
    cells[one] = expected[one] = static_cast<Cell>(rng.below(3));
  }
  ASSERT_TRUE(std::equal(cells.begin(), cells.end(), expected.begin(), expected.end()));
  for (const std::size_t begin : {0U, 31U, 32U, 517U}) {
    std::vector<std::size_t> occupied, visited;
    for (std::size_t i = begin; i < 900; ++i) {
      if (expected[i] == Cell::occupied) occupied.push_back(i);
    }
    cells.for_occupied(begin, 900, [&](std::size_t i) { visited.push_back(i); });
    EXPECT_EQ(visited, occupied);
  }
}

TEST(PackedCells, AreEqualIfEachOfThemIs) {
  const PackedCells cells{Cell::occupied, Cell::unknown, Cell::free};
  PackedCells others(3);
  EXPECT_NE(cells, others);
  others[0] = Cell::occupied;
  others[2] = Cell::free;
  EXPECT_EQ(cells, others);
  EXPECT_NE(cells, PackedCells(4));
}

TEST(OccupancyGrid, VisitsTheCellsThatItHoldsRowByRow) {
  const OccupancyGrid grid{{}, 0.5, 2, 3, PackedCells(6)};
  std::vector<std::size_t> visited;
  for_each_cell(grid, [&](int column, int row) { visited.push_back(grid.index(column, row)); });
  EXPECT_EQ(visited, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(grid.holds(0, 0) && grid.holds(1, 2));
  EXPECT_FALSE(grid.holds(-1, 0) || grid.holds(0, -1) || grid.holds(2, 0) || grid.holds(0, 3));
}

TEST(CellsUnder, AreThoseWhereAMotionPutsPoints) {
  const OccupancyGrid grid = two_cells();
  // The cells lie from x 0.5 to 1, the first from y 2 to 2.5, the second from y 2.5 to 3.
  const CellsUnder in_map(grid, {});
  EXPECT_EQ(in_map({0.75F, 2.25F, 0.0F}), Cell::occupied);
  EXPECT_EQ(in_map({0.75F, 2.75F, 0.0F}), Cell::free);
  EXPECT_EQ(in_map({1.25F, 2.25F, 0.0F}), Cell::unknown);
  EXPECT_EQ(in_map({0.75F, 3.25F, 0.0F}), Cell::unknown);
  // (x, y) is at (-y, 2 + x).
  const CellsUnder turned(grid, {0.0, 2.0, quarter});
  EXPECT_EQ(turned({0.75F, -0.75F, 0.0F}), Cell::free);
  EXPECT_EQ(turned({-0.25F, -0.75F, 0.0F}), Cell::unknown);
}

TEST(CellsUnder, AreThoseOfTheGridPointByPoint) {
  Rng rng(1);
  OccupancyGrid grid{{-3.0, 1.0, 0.3}, 0.1, 60, 40, PackedCells(std::size_t{60} * 40)};
  for (auto&& cell : grid.cells) cell = static_cast<Cell>(rng.below(3));
  const Pose2 pose{0.4, 2.0, -1.1};
  const CellsUnder cell_under(grid, pose);
  int differ = 0;
  Points points;
  std::vector<Cell> one_by_one;
  for (int i = 0; i < 5003; ++i) {
    const Point p{static_cast<float>(rng.uniform(-5.0, 5.0)), static_cast<float>(rng.uniform(-5.0, 5.0)),
                  0.0F};
    const Pose2 in_map = pose * Pose2{p.x, p.y, 0.0};
    points.push_back(p);
    one_by_one.push_back(cell_under(p));
    differ += one_by_one.back() == grid.at(in_map.x, in_map.y) ? 0 : 1;
  }
  EXPECT_LE(differ, 2);  // at the borders of cells, where numbers are rounded
  test::with_every_instruction_set([&] {
    std::vector<Cell> at_once;
    cell_under.find(points, at_once);
    EXPECT_EQ(at_once, one_by_one);
  });
}

TEST(CellsUnder, AreUnknownWithoutAGridAndForWhatIsNoNumber) {
  EXPECT_EQ(CellsUnder(OccupancyGrid{}, {})({0.0F, 0.0F, 0.0F}), Cell::unknown);
  const OccupancyGrid grid = two_cells();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(CellsUnder(grid, {})({nan, 2.25F, 0.0F}), Cell::unknown);
  EXPECT_EQ(CellsUnder(grid, {})({1e30F, 2.25F, 0.0F}), Cell::unknown);
}

}  // namespace
}  // namespace glocal::occupancy_grid_test
