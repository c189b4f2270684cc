// Points from grids.
#pragma once

#include "glocal/occupancy_grid.hpp"
#include "glocal/points.hpp"

namespace glocal {

/// The centres of all occupied cells, row by row, m, in the map's frame.
[[nodiscard]] Points occupied_centres(const OccupancyGrid& grid);

}  // namespace glocal
