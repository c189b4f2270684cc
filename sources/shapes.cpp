#include "sources/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glocal {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Position operator-(const Position& a, const Position& b) {
  return {a[0] - b[0], a[1] - b[1]};
}
double cross(const Position& a, const Position& b) {
  return a[0] * b[1] - a[1] * b[0];
}
double dot(const Position& a, const Position& b) {
  return a[0] * b[0] + a[1] * b[1];
}

/// A ray along a wall passes it; the walls at its ends are met.
double ray_distance(const Segment& segment, const Position& origin, const Position& direction) {
  const Position along = segment.to - segment.from;
  const Position start = segment.from - origin;
  const double area = cross(direction, along);
  if (area == 0.0) return infinite;
  const double distance = cross(start, along) / area;
  const double share = cross(start, direction) / area;
  if (distance < 0.0 || share < 0.0 || share > 1.0) return infinite;
  return distance;
}

double ray_distance(const Circle& circle, const Position& origin, const Position& direction) {
  const Position to_centre = circle.centre - origin;
  const double along = dot(to_centre, direction);
  const double half_chord_squared = circle.radius * circle.radius - dot(to_centre, to_centre) + along * along;
  if (half_chord_squared < 0.0) return infinite;
  const double half_chord = std::sqrt(half_chord_squared);
  if (along - half_chord >= 0.0) return along - half_chord;
  return along + half_chord >= 0.0 ? along + half_chord : infinite;
}

}  // namespace

double ray_distance(const Shapes& shapes, const Position& origin, const Position& direction) {
  double nearest = infinite;
  for (const Segment& s : shapes.segments) nearest = std::min(nearest, ray_distance(s, origin, direction));
  for (const Circle& c : shapes.circles) nearest = std::min(nearest, ray_distance(c, origin, direction));
  return nearest;
}

double clearance(const Shapes& shapes, const Position& place) {
  double nearest = infinite;
  for (const Segment& s : shapes.segments) {
    const Position along = s.to - s.from;
    const Position start = place - s.from;
    const double share = std::clamp(dot(start, along) / std::max(dot(along, along), 1e-12), 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(start[0] - share * along[0], start[1] - share * along[1]));
  }
  for (const Circle& c : shapes.circles) {
    nearest =
        std::min(nearest, std::abs(std::hypot(place[0] - c.centre[0], place[1] - c.centre[1]) - c.radius));
  }
  return nearest;
}

}  // namespace glocal
