// Cells of a grid that are far enough from others.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "glocal/occupancy_grid.hpp"
#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// Marks the cells around others.
class NearCells {
 public:
  /// Cells that have a place nearer than `distance` (m) to a place in the cell in the middle.
  NearCells(double distance, const OccupancyGrid& grid);

  /// The middle may lie outside of the grid. `marks` has one for each cell.
  void mark(int column, int row, std::vector<char>& marks) const;

 private:
  int width_, height_;            ///< Of the grid, in cells.
  std::vector<int> half_widths_;  ///< By how many rows away: columns to either side of the middle.
};

/// One mark for each cell: whether it is free, and every place in it is at least `clearance` (m) away from
/// every cell that is not. What lies outside of the grid is not free either.
[[nodiscard]] std::vector<char> clear_cells(const OccupancyGrid& grid, double clearance);

/// Marks the cells that have a place nearer than `distance` (m) to a marked cell.
[[nodiscard]] std::vector<char> grown(const std::vector<char>& marks, double distance,
                                      const OccupancyGrid& grid);

/// A place of the map in the grid's frame, in cells.
[[nodiscard]] Position on_grid(const Position& place, const OccupancyGrid& grid);

/// Index of the cell under a place of the map; none off the grid.
[[nodiscard]] std::optional<std::size_t> cell_under(const Position& place, const OccupancyGrid& grid);

}  // namespace glocal::simulation
