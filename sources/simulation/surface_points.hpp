// The surfaces of a simulated world as points in space.
#pragma once

#include <string>

#include "glocal/occupancy_grid.hpp"
#include "glocal/points.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// Points of all that the map of a world shows, m: the sides and tops of things, floor and ceiling over the
/// free cells of its plan, and the world's cloud; none in areas that are not mapped. Surfaces and cloud have
/// one point for each cube of the plan's resolution, floor and ceiling one for each cell. `file` is the
/// world's. Throws ConfigError for a world with too many points, or a faulty cloud.
[[nodiscard]] Points surface_points(const World& world, const OccupancyGrid& plan, const std::string& file);

}  // namespace glocal::simulation
