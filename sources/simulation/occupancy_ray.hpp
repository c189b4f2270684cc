// What a ray meets in a grid of free, occupied and unknown cells.
#pragma once

#include <limits>

#include "glocal/occupancy_grid.hpp"
#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// Distance (m) from a place on the map along a unit vector to where the ray enters an occupied cell, or to
/// `thing` (m), where it meets what is not on the map; infinite if there is neither within `reach` (m). Not a
/// number where it has gone farther than `max_unknown` (m) through unknown cells, or off the grid, before:
/// nobody knows what is there.
[[nodiscard]] double ray_distance(const OccupancyGrid& grid, const Position& origin,
                                  const Position& direction, double reach, double max_unknown,
                                  double thing = std::numeric_limits<double>::infinity());

/// As walls have blurred rims, m: what `max_unknown` is in simulations.
constexpr double unknown_rim = 0.2;

}  // namespace glocal::simulation
