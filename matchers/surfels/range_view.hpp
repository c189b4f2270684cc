// What a sensor saw in each direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "glocal/points.hpp"

namespace glocal::surfels {

/// Rays of a sensor: in each cell of directions, of about three degrees on the faces of a cube, the shortest.
class RangeView {
 public:
  /// Of a cloud that was seen from one place, both in the same frame.
  RangeView(const Points& cloud, const Point& seen_from);

  /// Whether a ray went through a surfel: through its plane at most `radius` (m) from its middle, and at
  /// least `radius` beyond it. The ray is that of the cell of the surfel's direction; without one, no.
  [[nodiscard]] bool saw_through(const Point& surfel, const Point& normal, float radius) const {
    const Point p = surfel - origin_;
    const Point end = ends_[cell_of(p)];
    const float to_end = dot(normal, end);
    const float to_plane = dot(normal, p);
    if (to_plane > 0.0F ? to_end < to_plane + radius : to_end > to_plane - radius) return false;
    const Point off = (to_plane / to_end) * end - p;
    return dot(off, off) < radius * radius;
  }

  /// Of the rays in the direction of a point, m; 0 without one.
  [[nodiscard]] float shortest_range_towards(const Point& p) const {
    return length(ends_[cell_of(p - origin_)]);
  }

  [[nodiscard]] const Point& origin() const { return origin_; }

 private:
  static constexpr std::size_t edge = 30;  ///< Cells along an edge of the cube.

  [[nodiscard]] static std::size_t cell_of(const Point& direction);

  Point origin_;
  std::vector<Point> ends_;  ///< Seen from the origin; (0, 0, 0) where there is no ray.
};

inline std::size_t RangeView::cell_of(const Point& direction) {
  const auto cell = [](std::size_t face, float u, float v, float most) {
    constexpr float half = 0.5F * static_cast<float>(edge);
    constexpr float least = 1e-30F;  // m; of less the scale would be infinite.
    const float scale = most > least ? half / most : 0.0F;
    const auto part = [&](float w) { return std::min(static_cast<std::size_t>(w * scale + half), edge - 1); };
    return (face * edge + part(u)) * edge + part(v);
  };
  const float x = std::abs(direction.x);
  const float y = std::abs(direction.y);
  const float z = std::abs(direction.z);
  if (x >= y && x >= z) return cell(direction.x > 0.0F ? 0 : 1, direction.y, direction.z, x);
  if (y >= z) return cell(direction.y > 0.0F ? 2 : 3, direction.x, direction.z, y);
  return cell(direction.z > 0.0F ? 4 : 5, direction.x, direction.y, z);
}

}  // namespace glocal::surfels
