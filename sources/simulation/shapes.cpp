#include "sources/simulation/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace glocal::simulation {
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

double distance_to(const Segment& segment, const Position& place) {
  const Position along = segment.to - segment.from;
  const Position start = place - segment.from;
  const double share = std::clamp(dot(start, along) / std::max(dot(along, along), 1e-12), 0.0, 1.0);
  return std::hypot(start[0] - share * along[0], start[1] - share * along[1]);
}

double distance_to(const Circle& circle, const Position& place) {
  return std::abs(distance(circle.centre, place) - circle.radius);
}

/// A ray in space and what is seen of it from above.
struct SpatialRay {
  SpatialRay(const Vector3& from, const Vector3& direction)
      : origin{from.x(), from.y()},
        run(std::hypot(direction.x(), direction.y())),
        // Straight up or down it has no direction in the plane; any will do.
        level{run > 0.0 ? direction.x() / run : 1.0, run > 0.0 ? direction.y() / run : 0.0},
        z(from.z()),
        rise(direction.z()) {}

  /// Where the ray meets an upright thing that it meets at `level_distance` when seen from above.
  [[nodiscard]] double distance_to_side(double level_distance, double height) const {
    if (level_distance == infinite || run == 0.0) return infinite;
    const double distance = level_distance / run;
    const double at = z + distance * rise;
    if (!(at >= 0.0 && at <= height)) return infinite;
    return distance;
  }

  /// Where the ray meets a level surface that is `inside` of some places only.
  template <class Inside>
  [[nodiscard]] double distance_to_level(double height, Inside inside) const {
    const double distance = (height - z) / rise;
    if (!(distance >= 0.0)) return infinite;  // not even where the ray runs within the surface
    const double way = distance * run;
    return inside(Position{origin[0] + way * level[0], origin[1] + way * level[1]}) ? distance : infinite;
  }

  Position origin;
  double run;  ///< Way in the plane for 1 m along the ray.
  Position level;
  double z;
  double rise;
};

double ray_distance(const Segment& segment, const SpatialRay& ray) {
  return ray.distance_to_side(ray_distance(segment, ray.origin, ray.level), segment.height);
}

double ray_distance(const Circle& circle, const SpatialRay& ray) {
  const auto inside = [&](const Position& p) { return distance(circle.centre, p) <= circle.radius; };
  return std::min(ray.distance_to_side(ray_distance(circle, ray.origin, ray.level), circle.height),
                  ray.distance_to_level(circle.height, inside));
}

double ray_distance(const Top& top, const SpatialRay& ray) {
  return ray.distance_to_level(top.height, [&](const Position& p) {
    bool is_left = true;
    bool is_right = true;
    for (std::size_t i = 0; i < top.corners.size(); ++i) {
      const Position& from = top.corners[i];
      const double side = cross(top.corners[(i + 1) % top.corners.size()] - from, p - from);
      is_left = is_left && side >= 0.0;
      is_right = is_right && side <= 0.0;
    }
    return is_left || is_right;
  });
}

}  // namespace

double ray_distance(const Shapes& shapes, const Position& origin, const Position& direction) {
  double nearest = infinite;
  for (const Segment& s : shapes.segments) nearest = std::min(nearest, ray_distance(s, origin, direction));
  for (const Circle& c : shapes.circles) nearest = std::min(nearest, ray_distance(c, origin, direction));
  return nearest;
}

double ray_distance_in_space(const Shapes& shapes, const Vector3& origin, const Vector3& direction) {
  const SpatialRay ray(origin, direction);
  double nearest = infinite;
  for (const Segment& s : shapes.segments) nearest = std::min(nearest, ray_distance(s, ray));
  for (const Circle& c : shapes.circles) nearest = std::min(nearest, ray_distance(c, ray));
  for (const Top& t : shapes.tops) nearest = std::min(nearest, ray_distance(t, ray));
  return nearest;
}

double clearance(const Shapes& shapes, const Position& place) {
  double nearest = infinite;
  for (const Segment& s : shapes.segments) nearest = std::min(nearest, distance_to(s, place));
  for (const Circle& c : shapes.circles) nearest = std::min(nearest, distance_to(c, place));
  return nearest;
}

}  // namespace glocal::simulation
