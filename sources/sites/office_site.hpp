// A simulated office of any size.
#pragma once

#include <cstdint>

#include "sources/simulation/world.hpp"

namespace glocal::sites {

/// A square of `side` (m, 20 or more) with an office in it, and the way points of a drive of
/// `drive_length` (m). Many rooms look alike. Part of the furniture has been moved, taken away or added since
/// the map was made, and some doors have been opened or shut. Every way is free, with 0.2 m on both sides.
[[nodiscard]] simulation::World office_site(double side, double drive_length, std::uint64_t seed);

}  // namespace glocal::sites
