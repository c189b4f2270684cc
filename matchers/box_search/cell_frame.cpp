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
  const auto least = [&](const std::vector<float>& values) { return extent_of(values).low - epsilon; };
  const auto cells = [&](const std::vector<float>& values) {
    const double most = extent_of(values).high + epsilon;
    return std::floor((most - least(values)) / cell) + 1.0;
  };
  const bool in_space = motion != Motion::planar;
  const double columns = cells(map_points.x);
  const double rows = cells(map_points.y);
  const double layers = in_space ? cells(map_points.z) : 1.0;
  constexpr double largest = 1024.0 * 1024.0 * 1024.0;
  if (!(columns * rows * layers <= largest)) {
    throw ConfigError("", fmt::format("the map is too large for a grid of cells of {} m: it would need more "
                                      "than 1 GiB; cut the map, or take a larger cell",
                                      cell));
  }
  return {.cell = cell,
          .min_x = least(map_points.x),
          .min_y = least(map_points.y),
          .min_z = in_space ? least(map_points.z) : 0.0,
          .columns = static_cast<int>(columns),
          .rows = static_cast<int>(rows),
          .layers = static_cast<int>(layers),
          .in_space = in_space};
}

}  // namespace glocal
