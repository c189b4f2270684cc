// How far coordinates reach.
#pragma once

#include <algorithm>
#include <vector>

#include "glocal/points.hpp"

namespace glocal {

/// From the lowest to the highest of some coordinates; (0, 0) of none.
struct Extent {
  float low = 0.0F, high = 0.0F;

  [[nodiscard]] double length() const { return double{high} - double{low}; }
  [[nodiscard]] double middle() const { return 0.5 * (double{low} + double{high}); }
};

[[nodiscard]] inline Extent extent_of(const std::vector<float>& values) {
  if (values.empty()) return {};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

/// Of the rectangle about all points, seen from above, m^2.
[[nodiscard]] inline double area_of(const Points& points) {
  return extent_of(points.x).length() * extent_of(points.y).length();
}

/// m^2; on larger maps cells are larger, too, as small ones would take most of the memory.
inline constexpr double huge_area = 25e4;

}  // namespace glocal
