#include "matchers/box_search/cell_frame.hpp"

#include <fmt/format.h>

#include <cmath>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"

namespace glocal {

void check_cell(double cell, double epsilon) {
  if (cell <= epsilon) return;
  throw ConfigError(
      "", fmt::format("the cell of {} m of an exact search is larger than contact_epsilon, which is "
                      "{:.3g} m on this map; take a smaller cell or a larger contact_epsilon",
                      cell, epsilon));
}

CellFrame cell_frame(const Points& map_points, double cell, double epsilon, Motion motion) {
  const bool in_space = motion != Motion::planar;
  const Extent x = extent_of(map_points.x), y = extent_of(map_points.y);
  const Extent z = in_space ? extent_of(map_points.z) : Extent{};
  const auto cells = [&](const Extent& along) {
    return std::floor((along.high + epsilon - (along.low - epsilon)) / cell) + 1.0;
  };
  const double columns = cells(x);
  const double rows = cells(y);
  const double layers = in_space ? cells(z) : 1.0;
  constexpr double largest = 1024.0 * 1024.0 * 1024.0;
  if (!(columns * rows * layers <= largest)) {
    throw ConfigError("", fmt::format("the map is too large for a grid of cells of {} m: it would need more "
                                      "than 1 GiB; cut the map, or take a larger cell",
                                      cell));
  }
  return {.cell = cell,
          .min_x = x.low - epsilon,
          .min_y = y.low - epsilon,
          .min_z = in_space ? z.low - epsilon : 0.0,
          .columns = static_cast<int>(columns),
          .rows = static_cast<int>(rows),
          .layers = static_cast<int>(layers),
          .in_space = in_space};
}

}  // namespace glocal
