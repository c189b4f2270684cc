#include "sources/simulation/clear_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "glocal/rng.hpp"
#include "sources/plan.hpp"

namespace glocal::simulation::clear_cells_test {
namespace {

/// Distance between the borders of two cells, in cells.
double between_borders(int columns, int rows) {
  return std::hypot(std::max(std::abs(columns) - 1, 0), std::max(std::abs(rows) - 1, 0));
}

TEST(ClearCells, AreFarFromAllThatIsNotFree) {
  OccupancyGrid grid{{}, 0.1, 23, 17, PackedCells(std::size_t{23} * 17, Cell::free)};
  Rng rng(3);
  for (int i = 0; i < 6; ++i) {
    const Cell kind = i % 2 == 0 ? Cell::occupied : Cell::unknown;
    grid.cells[rng.below(static_cast<std::uint32_t>(grid.cells.size()))] = kind;
  }
  for (const double clearance : {0.0, 0.05, 0.1, 0.15, 0.25, 0.4}) {
    const std::vector<char> is_clear = clear_cells(grid, clearance);
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        double nearest = 1e9;
        for (int r = -1; r <= grid.height; ++r) {
          for (int c = -1; c <= grid.width; ++c) {
            const bool is_on_grid = c >= 0 && c < grid.width && r >= 0 && r < grid.height;
            if (is_on_grid && grid.cell(c, r) == Cell::free) continue;
            nearest = std::min(nearest, between_borders(c - column, r - row));
          }
        }
        const bool expected = grid.cell(column, row) == Cell::free && nearest >= clearance / 0.1;
        ASSERT_EQ(is_clear[grid.index(column, row)] != 0, expected)
            << column << ", " << row << " with " << clearance;
      }
    }
  }
}

TEST(NearCells, AreThoseWithinTheDistance) {
  const OccupancyGrid grid{{}, 0.5, 9, 7, PackedCells(63, Cell::free)};
  std::vector<char> marks(63, 0);
  NearCells(1.1, grid).mark(-1, 2, marks);  // beside the grid; 2.2 cells
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 9; ++column)
      EXPECT_EQ(marks[grid.index(column, row)] != 0, between_borders(column + 1, row - 2) < 2.2);
  }
}

TEST(CellUnder, IsOneOfTheGridOrNone) {
  // Turned by 90 degrees: what was x is y, what was y is -x. The room has 12 x 7 cells of 0.5 m.
  const OccupancyGrid grid = test::Plan(test::room_plan, "[0, 0, 1.5707963267948966]").grid();
  EXPECT_EQ(cell_under({-1.75, 2.75}, grid), grid.index(5, 3)) << "the pillar";
  EXPECT_EQ(cell_under({-1.75, 6.01}, grid), std::nullopt);
  EXPECT_EQ(cell_under({0.01, 1.0}, grid), std::nullopt);
  EXPECT_EQ(cell_under({std::nan(""), 1.0}, grid), std::nullopt);
}

}  // namespace
}  // namespace glocal::simulation::clear_cells_test
