#include "sources/clear_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace glocal {

void mark_cells_near(int column, int row, double distance, const OccupancyGrid& grid,
                     std::vector<char>& marks) {
  const double reach = distance / grid.resolution;
  const int cells = static_cast<int>(std::ceil(reach));
  for (int r = std::max(row - cells, 0); r <= std::min(row + cells, grid.height - 1); ++r) {
    for (int c = std::max(column - cells, 0); c <= std::min(column + cells, grid.width - 1); ++c) {
      const int between_columns = std::max(std::abs(c - column) - 1, 0);
      const int between_rows = std::max(std::abs(r - row) - 1, 0);
      if (std::hypot(between_columns, between_rows) < reach) marks[grid.index(c, r)] = 1;
    }
  }
}

std::vector<char> clear_cells(const OccupancyGrid& grid, double clearance) {
  const auto is_free = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < grid.width && row < grid.height &&
           grid.cell(column, row) == Cell::free;
  };
  std::vector<char> is_near(grid.cells.size(), 0);
  for (int row = -1; row <= grid.height; ++row) {
    for (int column = -1; column <= grid.width; ++column) {
      // Others are farther from any free cell than one of these.
      const bool borders_on_free = is_free(column - 1, row) || is_free(column + 1, row) ||
                                   is_free(column, row - 1) || is_free(column, row + 1);
      if (!is_free(column, row) && borders_on_free) mark_cells_near(column, row, clearance, grid, is_near);
    }
  }
  std::vector<char> is_clear(grid.cells.size());
  for (std::size_t i = 0; i < is_clear.size(); ++i)
    is_clear[i] = grid.cells[i] == Cell::free && is_near[i] == 0 ? 1 : 0;
  return is_clear;
}

std::optional<std::size_t> cell_under(const Position& place, const OccupancyGrid& grid) {
  const Pose2 p = inverse(grid.map_from_grid) * Pose2{place[0], place[1], 0.0};
  const double column = std::floor(p.x / grid.resolution);
  const double row = std::floor(p.y / grid.resolution);
  // Negated so that NaN falls outside.
  if (!(column >= 0.0 && column < grid.width && row >= 0.0 && row < grid.height)) return std::nullopt;
  return grid.index(static_cast<int>(column), static_cast<int>(row));
}

}  // namespace glocal
