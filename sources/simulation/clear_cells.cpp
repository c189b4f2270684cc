#include "sources/simulation/clear_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace glocal::simulation {

NearCells::NearCells(double distance, const OccupancyGrid& grid) : width_(grid.width), height_(grid.height) {
  const double reach = distance / grid.resolution;
  // From border to border, so that neighbours have no distance.
  const auto is_near = [&](int columns, int rows) {
    return std::hypot(std::max(columns - 1, 0), std::max(rows - 1, 0)) < reach;
  };
  for (int rows = 0; is_near(0, rows) && rows < height_ + 2; ++rows) {
    int columns = 0;
    while (is_near(columns + 1, rows) && columns < width_ + 2) ++columns;
    half_widths_.push_back(columns);
  }
}

void NearCells::mark(int column, int row, std::vector<char>& marks) const {
  const int rows = static_cast<int>(half_widths_.size());
  for (int r = std::max(row - rows + 1, 0); r <= std::min(row + rows - 1, height_ - 1); ++r) {
    const int half_width = half_widths_[static_cast<std::size_t>(std::abs(r - row))];
    const int first = std::max(column - half_width, 0);
    const int last = std::min(column + half_width, width_ - 1);
    const auto of_row = marks.begin() + static_cast<std::ptrdiff_t>(r) * width_;
    if (first <= last) std::fill(of_row + first, of_row + last + 1, 1);
  }
}

std::vector<char> clear_cells(const OccupancyGrid& grid, double clearance) {
  const auto is_free = [&](int column, int row) {
    return grid.holds(column, row) && grid.cell(column, row) == Cell::free;
  };
  const NearCells near_cells(clearance, grid);
  std::vector<char> is_near(grid.cells.size(), 0);
  for (int row = -1; row <= grid.height; ++row) {
    for (int column = -1; column <= grid.width; ++column) {
      // Others are farther from any free cell than one of these.
      const bool borders_on_free = is_free(column - 1, row) || is_free(column + 1, row) ||
                                   is_free(column, row - 1) || is_free(column, row + 1);
      if (!is_free(column, row) && borders_on_free) near_cells.mark(column, row, is_near);
    }
  }
  std::vector<char> is_clear(grid.cells.size());
  for (std::size_t i = 0; i < is_clear.size(); ++i)
    is_clear[i] = grid.cells[i] == Cell::free && is_near[i] == 0 ? 1 : 0;
  return is_clear;
}

std::vector<char> grown(const std::vector<char>& marks, double distance, const OccupancyGrid& grid) {
  const NearCells near_cells(distance, grid);
  std::vector<char> all(marks.size(), 0);
  for_each_cell(grid, [&](int column, int row) {
    if (marks[grid.index(column, row)] != 0) near_cells.mark(column, row, all);
  });
  return all;
}

Position on_grid(const Position& place, const OccupancyGrid& grid) {
  const Pose2 p = inverse(grid.map_from_grid) * Pose2{place[0], place[1], 0.0};
  return {p.x / grid.resolution, p.y / grid.resolution};
}

std::optional<std::size_t> cell_under(const Position& place, const OccupancyGrid& grid) {
  const Position p = on_grid(place, grid);
  const double column = std::floor(p[0]);
  const double row = std::floor(p[1]);
  // Negated so that NaN falls outside.
  if (!(column >= 0.0 && column < grid.width && row >= 0.0 && row < grid.height)) return std::nullopt;
  return grid.index(static_cast<int>(column), static_cast<int>(row));
}

}  // namespace glocal::simulation
