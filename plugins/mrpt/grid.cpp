#include "grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "glocal/error.hpp"

namespace glocal::mrpt_plugin {
namespace {

/// How likely a cell is free, for MRPT.
constexpr float surely_free = 0.99F;
constexpr float surely_occupied = 0.01F;
constexpr float unknown = 0.5F;

/// Counted from cell (0, 0) of the map's grid.
struct CellOfGrid {
  std::int64_t column = 0;
  std::int64_t row = 0;
};

std::vector<CellOfGrid> cells_of(const Points& points, const OccupancyGrid& grid) {
  const Pose2 grid_from_map = inverse(grid.map_from_grid);
  std::vector<CellOfGrid> cells;
  cells.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Pose2 place = grid_from_map * Pose2{points[i].x, points[i].y, 0.0};
    cells.push_back({static_cast<std::int64_t>(std::floor(place.x / grid.resolution)),
                     static_cast<std::int64_t>(std::floor(place.y / grid.resolution))});
  }
  return cells;
}

ConfigError fault(std::string message) {
  return ConfigError("", std::move(message));
}

}  // namespace

MrptGrid mrpt_grid(const GlobalMap& map) {
  const OccupancyGrid& grid = map.grid();
  if (std::find(grid.cells.begin(), grid.cells.end(), Cell::free) == grid.cells.end()) {
    throw fault(
        "the map has no cell that is known to be free, so there is no place for particles; take a map with "
        "free space, or another matcher");
  }
  const std::vector<CellOfGrid> walls = cells_of(map.points(), grid);
  CellOfGrid first;
  CellOfGrid end{grid.width, grid.height};
  for (const CellOfGrid& cell : walls) {
    first = {std::min(first.column, cell.column), std::min(first.row, cell.row)};
    end = {std::max(end.column, cell.column + 1), std::max(end.row, cell.row + 1)};
  }
  const auto width = static_cast<double>(end.column - first.column);
  const auto height = static_cast<double>(end.row - first.row);
  constexpr double most_cells = 64e6;  // floats, beside a field of distances
  if (width * height > most_cells) {
    throw fault(
        fmt::format("the map's points reach over {:.0f} x {:.0f} cells of {} m, which is more than {:.0f} "
                    "million cells; take a coarser map, or another matcher",
                    width, height, grid.resolution, most_cells / 1e6));
  }

  const double resolution = grid.resolution;
  const auto column_of = [&](std::int64_t column) { return static_cast<int>(column - first.column); };
  const auto row_of = [&](std::int64_t row) { return static_cast<int>(row - first.row); };
  MrptGrid made;
  made.map_from_cells = grid.map_from_grid * Pose2{static_cast<double>(first.column) * resolution,
                                                   static_cast<double>(first.row) * resolution, 0.0};
  made.cells = std::make_shared<mrpt::maps::COccupancyGridMap2D>();
  made.cells->setSize(0.0F, static_cast<float>(width * resolution), 0.0F,
                      static_cast<float>(height * resolution), static_cast<float>(resolution), unknown);
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const Cell cell = grid.cell(column, row);
      if (cell == Cell::unknown) continue;
      made.cells->setCell(column_of(column), row_of(row), cell == Cell::free ? surely_free : surely_occupied);
    }
  }
  for (const CellOfGrid& wall : walls)
    made.cells->setCell(column_of(wall.column), row_of(wall.row), surely_occupied);
  return made;
}

}  // namespace glocal::mrpt_plugin
