// What rays meet in a simulated world.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "glocal/pose3.hpp"

namespace glocal::simulation {

using Position = std::array<double, 2>;  ///< x, y (m)

[[nodiscard]] inline double distance(const Position& a, const Position& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

/// A share of the straight way from a place to another.
[[nodiscard]] inline Position between(const Position& a, const Position& b, double share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
}

/// Heights are those of things that stand on the floor, m; in the plane nobody asks for them.
struct Segment {
  Position from;
  Position to;
  double height = 0.0;
};

struct Circle {
  Position centre;
  double radius = 0.0;  ///< m
  double height = 0.0;
};

/// The level upper side of a box, between four corners in order.
struct Top {
  std::array<Position, 4> corners;
  double height = 0.0;
};

struct Shapes {
  std::vector<Segment> segments = {};
  std::vector<Circle> circles = {};
  std::vector<Top> tops = {};
};

/// Distance from `origin` along the unit vector `direction` to the first shape, m; infinite if there is none.
/// From within a circle it is the distance to its rim.
[[nodiscard]] double ray_distance(const Shapes& shapes, const Position& origin, const Position& direction);

/// The same in space, where segments are upright walls, and circles are upright columns with tops. z is the
/// height over the floor, which is no shape.
[[nodiscard]] double ray_distance_in_space(const Shapes& shapes, const Vector3& origin,
                                           const Vector3& direction);

/// Distance from a place to the nearest shape's outline, m.
[[nodiscard]] double clearance(const Shapes& shapes, const Position& place);

}  // namespace glocal::simulation
