// The cells a ray crosses.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace glocal {

/// Calls visit(cell, share) for each cell a straight line enters before the cell it ends in, in order, with
/// the share of the line that lies before the cell, until visit() returns false (Amanatides and Woo, "A fast
/// voxel traversal algorithm for ray tracing", Eurographics 1987). Coordinates are in cells, of any
/// dimension.
template <std::size_t Dimensions, class Visit>
void visit_cells_before_end(const std::array<double, Dimensions>& from,
                            const std::array<double, Dimensions>& to, Visit visit) {
  constexpr double never = std::numeric_limits<double>::infinity();
  std::array<int, Dimensions> cell{};
  std::array<int, Dimensions> end{};
  std::array<int, Dimensions> step{};
  // Shares of the line from border to border, and from its start to the next one.
  std::array<double, Dimensions> delta{};
  std::array<double, Dimensions> next{};
  // The number of borders is known beforehand, so that rounding cannot lead past the end.
  int left = 0;
  for (std::size_t axis = 0; axis < Dimensions; ++axis) {
    const double way = to[axis] - from[axis];
    cell[axis] = static_cast<int>(std::floor(from[axis]));
    end[axis] = static_cast<int>(std::floor(to[axis]));
    step[axis] = way > 0.0 ? 1 : -1;
    delta[axis] = way == 0.0 ? never : std::abs(1.0 / way);
    next[axis] = way == 0.0 ? never : ((way > 0.0 ? cell[axis] + 1 : cell[axis]) - from[axis]) / way;
    left += std::abs(end[axis] - cell[axis]);
  }
  for (double share = 0.0; left > 0 && visit(cell, share); --left) {
    std::size_t nearest = Dimensions;
    for (std::size_t axis = 0; axis < Dimensions; ++axis) {
      if (cell[axis] == end[axis]) continue;
      if (nearest == Dimensions || next[axis] < next[nearest]) nearest = axis;
    }
    cell[nearest] += step[nearest];
    share = next[nearest];
    next[nearest] += delta[nearest];
  }
}

/// The same in the plane: calls visit(column, row, share).
template <class Visit>
void visit_cells_before_end(double x0, double y0, double x1, double y1, Visit visit) {
  visit_cells_before_end<2>({x0, y0}, {x1, y1}, [&](const std::array<int, 2>& cell, double share) {
    return visit(cell[0], cell[1], share);
  });
}

}  // namespace glocal
