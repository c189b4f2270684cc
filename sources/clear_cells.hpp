// Cells of a grid that are far enough from others.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "glocal/occupancy_grid.hpp"
#include "sources/shapes.hpp"

namespace glocal {

/// Marks the cells that have a place nearer than `distance` (m) to a place in the cell (column, row), which
/// may lie outside of the grid. `marks` has one for each cell.
void mark_cells_near(int column, int row, double distance, const OccupancyGrid& grid,
                     std::vector<char>& marks);

/// One mark for each cell: whether it is free, and every place in it is at least `clearance` (m) away from
/// every cell that is not. What lies outside of the grid is not free either.
[[nodiscard]] std::vector<char> clear_cells(const OccupancyGrid& grid, double clearance);

/// Index of the cell under a place of the map; none off the grid.
[[nodiscard]] std::optional<std::size_t> cell_under(const Position& place, const OccupancyGrid& grid);

}  // namespace glocal
