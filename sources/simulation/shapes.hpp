// What rays meet in a simulated world.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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

/// Length of a way of straight parts, m.
[[nodiscard]] inline double length_of(const std::vector<Position>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += distance(way[i - 1], way[i]);
  return length;
}

/// A rectangle around places.
struct Bounds {
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  Position low{infinite, infinite};
  Position high{-infinite, -infinite};

  /// Takes in a place, and what is as near to it along either axis.
  void add(const Position& place, double around) {
    for (std::size_t axis = 0; axis < place.size(); ++axis) {
      low[axis] = std::min(low[axis], place[axis] - around);
      high[axis] = std::max(high[axis], place[axis] + around);
    }
  }
};

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
