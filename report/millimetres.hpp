// Points on a grid of 1 mm, the finest that a report shows.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <vector>

#include "glocal/points.hpp"

namespace glocal {

/// mm.
struct GridPoint {
  int x = 0;
  int y = 0;
  int z = 0;

  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;  // NOLINT(modernize-use-nullptr)
};

/// The points rounded to whole mm, in their order; they must lie within 2000 km.
[[nodiscard]] inline std::vector<GridPoint> in_millimetres(const Points& points) {
  const auto rounded = [](float metres) { return static_cast<int>(std::lround(1000.0 * metres)); };
  std::vector<GridPoint> grid_points;
  grid_points.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    grid_points.push_back({rounded(points.x[i]), rounded(points.y[i]), rounded(points.z[i])});
  return grid_points;
}

/// False for what a planar laser has seen.
template <class Heights>
[[nodiscard]] bool has_heights(const Heights& z) {
  return std::any_of(z.begin(), z.end(), [](auto height) { return height != 0; });
}

}  // namespace glocal
