// What is known to be free, occupied or unknown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose2.hpp"

namespace glocal {

/// Grids of more cells are refused.
inline constexpr double max_grid_cells = 1e9;

/// What the map knows of a cell.
enum class Cell : std::uint8_t { unknown, free, occupied };

/// Square cells over a rectangle; row 0 is the lowest y of the grid's frame, cell (0, 0) starts at its
/// origin.
struct OccupancyGrid {
  Pose2 map_from_grid;      ///< Outer corner of cell (0, 0), and the direction of the columns.
  double resolution = 0.0;  ///< Side of a cell, m.
  int width = 0;            ///< Cells along the grid's x.
  int height = 0;           ///< Cells along the grid's y.
  std::vector<Cell> cells;  ///< width * height, row by row.

  /// The cell under a point of the map's frame; outside the grid everything is unknown.
  [[nodiscard]] Cell at(double map_x, double map_y) const;
  [[nodiscard]] Cell& cell(int column, int row) { return cells[index(column, row)]; }
  [[nodiscard]] Cell cell(int column, int row) const { return cells[index(column, row)]; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  /// Centre of a cell in the map's frame.
  [[nodiscard]] Pose2 centre(int column, int row) const {
    return map_from_grid * Pose2{(column + 0.5) * resolution, (row + 0.5) * resolution, 0.0};
  }
};

/// The cells under many points, which one motion takes to the map's frame.
class CellsUnder {
 public:
  /// The grid must outlive this.
  CellsUnder(const OccupancyGrid& grid, const Pose2& map_from_points);
  /// Outside the grid everything is unknown.
  [[nodiscard]] Cell operator()(const Point& p) const;
  /// Of all points: what `cells` had is lost.
  void find(const Points& points, std::vector<Cell>& cells) const;

 private:
  const OccupancyGrid& grid_;
  Transform grid_from_points_;
  float scale_;  ///< Cells per metre; 0 without a grid.
};

/// The centres of all occupied cells, row by row, m, in the map's frame.
[[nodiscard]] Points occupied_centres(const OccupancyGrid& grid);

}  // namespace glocal
