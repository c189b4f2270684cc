// Simulated worlds as grids of cells.
#pragma once

#include "glocal/occupancy_grid.hpp"
#include "sources/world.hpp"

namespace glocal {

/// What the map of a world shows, seen from above: outlines, one cell thick, and the free space around the
/// places of `free_from`. Cells are centred on multiples of the resolution (m).
[[nodiscard]] OccupancyGrid plan_of(const World& world, double resolution);

/// What is there in reality but for people and a cloud, in the same way; free space is where the drive
/// begins. Cells have a side of 0.05 m, or more in worlds of over a hectare.
[[nodiscard]] OccupancyGrid reality_of(const World& world);

}  // namespace glocal
