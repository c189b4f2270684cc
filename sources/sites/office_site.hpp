// A simulated office of any size.
#pragma once

#include <cstdint>
#include <optional>

#include "sources/simulation/world.hpp"

namespace glocal::sites {

/// A square of `side` (m, 20 or more) with an office in it, and the way points of a drive of
/// `drive_length` (m). Many rooms look alike. Part of the furniture has been moved, taken away or added since
/// the map was made, and some doors have been opened or shut. Every way is free, with 0.2 m on both sides.
/// Offices of one seed with another `furniture_seed` have the same rooms, doors and ways.
[[nodiscard]] simulation::World office_site(double side, double drive_length, std::uint64_t seed,
                                            std::optional<std::uint64_t> furniture_seed = {});

}  // namespace glocal::sites
