// The map, as MRPT has it.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <memory>

#include "glocal/global_map.hpp"
#include "glocal/pose2.hpp"

namespace glocal::mrpt_plugin {

/// An occupancy grid of MRPT, which begins at the origin of a frame of its own: MRPT's grids are not turned,
/// count in single precision, and begin at multiples of their cells only.
struct MrptGrid {
  std::shared_ptr<mrpt::maps::COccupancyGridMap2D> cells;
  Pose2 map_from_cells;
};

/// Cells with a point of the map are occupied, of the others those that the map's grid says; what neither
/// knows is as likely free as not. Throws ConfigError if no cell is known to be free, or the map's points
/// reach over too many cells.
[[nodiscard]] MrptGrid mrpt_grid(const GlobalMap& map);

}  // namespace glocal::mrpt_plugin
