// Hits that no other beam of their scan confirms.
#pragma once

#include <vector>

#include "glocal/points.hpp"

namespace glocal::local_mappers {

/// For each hit in beam order, seen from `sensor` (same frame, m), whether it stands alone: none of the three
/// hits before and after it is as near as it would be on one surface seen at 20 degrees or more. Sunlight,
/// dust and other lasers leave such hits; they are never where the map has something, and those of each scan
/// are elsewhere.
[[nodiscard]] std::vector<bool> lone_hits(const Points& hits, const Point& sensor);

}  // namespace glocal::local_mappers
