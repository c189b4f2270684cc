// What stands about in a simulated office, on its map and in reality.
#pragma once

#include "glocal/rng.hpp"
#include "sources/simulation/world.hpp"
#include "sources/sites/office_plan.hpp"

namespace glocal::sites {

/// How far (m) a robot may be from the middle of a corridor; furniture leaves a way for it.
inline constexpr double lane_offset = 0.1;

/// Puts furniture into all rooms and along all corridors. Rooms that are alike get the same furniture, but
/// for some that is missing, stands a little elsewhere, or that only this room has. A part is moved, removed
/// or added after the map was made. Robots' ways into rooms and along corridors stay free.
void furnish(const OfficePlan& plan, Rng rng, simulation::World& world);

}  // namespace glocal::sites
