// What rays meet in a simulated world.
#pragma once

#include <array>
#include <vector>

namespace glocal {

using Position = std::array<double, 2>;  ///< x, y (m)

struct Segment {
  Position from;
  Position to;
};

struct Circle {
  Position centre;
  double radius = 0.0;  ///< m
};

struct Shapes {
  std::vector<Segment> segments;
  std::vector<Circle> circles;
};

/// Distance from `origin` along the unit vector `direction` to the first shape, m; infinite if there is none.
/// From within a circle it is the distance to its rim.
[[nodiscard]] double ray_distance(const Shapes& shapes, const Position& origin, const Position& direction);

/// Distance from a place to the nearest shape's outline, m.
[[nodiscard]] double clearance(const Shapes& shapes, const Position& place);

}  // namespace glocal
