// Simulated worlds as grids of cells, and as points in space.
#pragma once

#include <string>
#include <vector>

#include "glocal/occupancy_grid.hpp"
#include "glocal/points.hpp"
#include "sources/clouds/cloud_voxels.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// What the map of a world shows, seen from above: outlines, one cell thick, and the free space around the
/// places of `free_from`. Cells are centred on multiples of the resolution (m). Throws ConfigError at
/// `place`, a file or an option, if there were more than max_grid_cells.
[[nodiscard]] OccupancyGrid plan_of(const World& world, double resolution, const std::string& origin);

/// What is there in reality but for people and a cloud, in the same way; free space is where the drive
/// begins: around its first way point that is in no cell of an outline. Cells have a side of 0.05 m, or more
/// in worlds of over a hectare.
[[nodiscard]] OccupancyGrid reality_of(const World& world);

/// The voxels of a world's cloud. Throws ConfigError if that is none, or too large.
[[nodiscard]] clouds::CloudVoxels voxels_of(const World& world);

/// Where things can stand and people can walk in a world with a cloud, within 10 m of some places: a cell for
/// each column of voxels. Free is the cloud's floor as far as it can be reached from the places through
/// openings of 0.4 m: voxels within 0.2 m of the world's floor, with gaps of up to 0.5 m between them, and no
/// others from there to 2 m over it, nor things. Throws ConfigError at `file`, the world's, if there is no
/// such floor, or if there were too many cells.
[[nodiscard]] OccupancyGrid floor_near(const std::vector<Position>& places, const World& world,
                                       const clouds::CloudVoxels& cloud, const std::string& file);

/// Points of all that the map of a world shows, m: the sides and tops of things, floor and ceiling over the
/// free cells of its plan, and the world's cloud; none in areas that are not mapped. Surfaces and cloud have
/// one point for each cube of the plan's resolution, floor and ceiling one for each cell. `file` is the
/// world's. Throws ConfigError for a world with too many points, or a faulty cloud.
[[nodiscard]] Points surface_points(const World& world, const OccupancyGrid& plan, const std::string& file);

}  // namespace glocal::simulation
