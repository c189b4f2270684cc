// A map that is not as the world is.
#pragma once

#include <span>

#include "glocal/global_map.hpp"
#include "glocal/rng.hpp"
#include "sources/disturbed/chosen.hpp"

namespace glocal::disturbed {

/// A kind of disturbance of maps.
struct MapDisturbanceKind : Kind {
  bool needs_cells;  ///< Whether it can change maps with cells only.
  void (*change)(MapData& map, double amount, Rng& rng);
};

/// All of them.
[[nodiscard]] std::span<const MapDisturbanceKind> map_disturbance_kinds();

}  // namespace glocal::disturbed
