// What a search of a whole map costs grows with its area.
#pragma once

#include <algorithm>
#include <cstddef>

#include "glocal/extent.hpp"
#include "glocal/global_map.hpp"

namespace glocal {

constexpr double large_area = 2e4;  ///< m^2

/// Side of the smallest boxes of poses, m: small ones bound more tightly, and take memory and time by the
/// area. At most `epsilon`.
[[nodiscard]] inline double automatic_box_cell(const GlobalMap& map, double epsilon) {
  const double area = area_of(map.points());
  const double cell = area > huge_area ? 0.1 : area > large_area ? 0.05 : 0.025;
  return std::min(cell, epsilon);
}

/// The same in space, by the volume.
[[nodiscard]] inline double automatic_box_cell_in_space(const GlobalMap& map, double epsilon) {
  constexpr double many_cells = 4e8;
  const double half = epsilon / 2.0;
  const double cells = area_of(map.points()) * extent_of(map.points().z).length() / (half * half * half);
  return cells > many_cells ? epsilon : half;
}

/// So many looks of a point are allowed on a map of large_area, and as many more as a map is larger.
[[nodiscard]] inline std::size_t looks_on(const GlobalMap& map, double looks) {
  return static_cast<std::size_t>(looks * std::max(1.0, area_of(map.points()) / large_area));
}

}  // namespace glocal
