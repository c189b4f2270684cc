// A map that is not as the world is.
#pragma once

#include <span>

#include "glocal/global_map.hpp"
#include "glocal/rng.hpp"
#include "sources/disturbed/chosen.hpp"

namespace glocal::disturbed {

/// What a disturbance changes of a map.
enum class Changes {
  cells,   ///< Of a plan, which points follow.
  points,  ///< Here and there; cells follow.
  places,  ///< What is where on the whole map. It must be one map, and what it knew to be free is no longer
           ///< so.
};

/// A kind of disturbance of maps.
struct MapDisturbanceKind : Kind {
  Changes changes;
  void (*change)(MapData& map, double amount, Rng& rng);
};

/// Whether the points of a map are not those of a plan.
[[nodiscard]] bool has_heights(const MapData& map);

/// All of them.
[[nodiscard]] std::span<const MapDisturbanceKind> map_disturbance_kinds();

}  // namespace glocal::disturbed
