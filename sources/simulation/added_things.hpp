// Boxes and people that are there when a robot drives, and that nobody has mapped: by number, at random.
#pragma once

#include <string>
#include <vector>

#include "glocal/occupancy_grid.hpp"
#include "glocal/rng.hpp"
#include "sources/simulation/clear_region.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// People who walk to and fro, each between two places drawn in a region, by a shortest way, at 0.4 to 1.2
/// m/s.
[[nodiscard]] std::vector<Walker> drawn_people(int count, const ClearRegion& region, Rng rng);

/// Boxes with sides of 0.3 to 1 m and a height of 0.5 to 1.5 m, on free cells only, around places drawn in a
/// region, apart from each other and at least `clearance` (m) away from `ways`. They are not on the map.
/// Throws ConfigError at `file` if there is no place for so many.
[[nodiscard]] std::vector<Rectangle> drawn_boxes(int count, const OccupancyGrid& grid,
                                                 const ClearRegion& region,
                                                 const std::vector<std::vector<Position>>& ways,
                                                 double clearance, Rng rng, const std::string& file);

}  // namespace glocal::simulation
