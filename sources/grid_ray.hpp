// The cells a ray crosses.
#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>

namespace glocal {

/// Calls visit(column, row, share) for each cell a straight line enters before the cell it ends in, in order,
/// with the share of the line that lies before the cell, until visit() returns false (Amanatides and Woo, "A
/// fast voxel traversal algorithm for ray tracing", Eurographics 1987). Coordinates are in cells.
template <class Visit>
void visit_cells_before_end(double x0, double y0, double x1, double y1, Visit visit) {
  int column = static_cast<int>(std::floor(x0));
  int row = static_cast<int>(std::floor(y0));
  const int end_column = static_cast<int>(std::floor(x1));
  const int end_row = static_cast<int>(std::floor(y1));
  const double dx = x1 - x0;
  const double dy = y1 - y0;
  const int step_x = dx > 0.0 ? 1 : -1;
  const int step_y = dy > 0.0 ? 1 : -1;
  // Shares of the line from its start to the next border, and from border to border.
  constexpr double never = std::numeric_limits<double>::infinity();
  const double delta_x = dx == 0.0 ? never : std::abs(1.0 / dx);
  const double delta_y = dy == 0.0 ? never : std::abs(1.0 / dy);
  double next_x = dx == 0.0 ? never : ((dx > 0.0 ? column + 1 : column) - x0) / dx;
  double next_y = dy == 0.0 ? never : ((dy > 0.0 ? row + 1 : row) - y0) / dy;
  double share = 0.0;
  // The number of borders is known beforehand, so that rounding cannot lead past the end.
  for (int left = std::abs(end_column - column) + std::abs(end_row - row); left > 0; --left) {
    if (!visit(column, row, share)) return;
    if (row == end_row || (column != end_column && next_x <= next_y)) {
      column += step_x;
      share = next_x;
      next_x += delta_x;
    } else {
      row += step_y;
      share = next_y;
      next_y += delta_y;
    }
  }
}

}  // namespace glocal
