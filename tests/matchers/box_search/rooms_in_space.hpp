// Rooms in space, and a robot in one of them.
#pragma once

#include <cmath>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "glocal/rng.hpp"

namespace glocal::test::rooms_in_space {

/// The robot leans, and is not where the local frame begins.
inline const Pose3 local_from_robot({0.3, -0.2, 0.4}, turn_about_z(0.8) * exponential({0.03, 0.02, 0.0}));

inline Point point(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

inline void add(Points& points, const Points& more) {
  for (std::size_t i = 0; i < more.size(); ++i) points.push_back(more[i]);
}

inline Points random_points(Rng& rng, std::size_t n, double width, double depth, double height) {
  Points points;
  for (std::size_t i = 0; i < n; ++i)
    points.push_back(point(rng.uniform(0.0, width), rng.uniform(0.0, depth), rng.uniform(0.0, height)));
  return points;
}

/// Points nearer to one of the map than this, each looked at.
inline std::size_t brute_count(const Points& map, const Points& points, const Pose3& map_from_local,
                               double near) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 p = map_from_local * Vector3{points.x[i], points.y[i], points.z[i]};
    bool found = false;
    for (std::size_t k = 0; k < map.size() && !found; ++k) {
      const double dx = map.x[k] - p.x();
      const double dy = map.y[k] - p.y();
      const double dz = map.z[k] - p.z();
      found = dx * dx + dy * dy + dz * dz <= near * near;
    }
    n += found ? 1 : 0;
  }
  return n;
}

/// Floor and walls of a room of 4 m x 2.8 m x 2 m, with a wall into it, at the left or elsewhere: it looks
/// different from every side. Its corner is at (x, y, z).
inline Points room(double x, double y, double z, bool is_left, double apart = 0.2) {
  Points points;
  const auto each = [&](double length, auto use) {
    for (int i = 0; i <= std::lround(length / apart); ++i) use(apart * i);
  };
  each(4.0, [&](double u) {
    each(2.8, [&](double v) { points.push_back(point(x + u, y + v, z)); });
    each(2.0, [&](double h) {
      points.push_back(point(x + u, y, z + h));
      points.push_back(point(x + u, y + 2.8, z + h));
    });
  });
  each(2.0, [&](double h) {
    each(2.8, [&](double v) {
      points.push_back(point(x, y + v, z + h));
      points.push_back(point(x + 4.0, y + v, z + h));
    });
    each(1.6, [&](double v) { points.push_back(point(x + (is_left ? 0.9 : 2.7), y + v, z + h)); });
  });
  return points;
}

/// Where the local frame lies in a room with this corner.
inline Pose3 map_from_local_in(double x, double y, double z) {
  return Pose3({x + 2.0, y + 1.5, z + 1.0}, turn_about_z(0.3));
}

/// What a robot in such a room sees: fewer points than the map has.
inline Points seen_in_room() {
  return moved(room(0.0, 0.0, 0.0, true, 0.4), inverse(map_from_local_in(0.0, 0.0, 0.0)));
}

/// A room, one that is another one beside it, and things in the air.
inline Points two_rooms() {
  Rng rng(3);
  Points map = room(0.0, 0.0, 0.0, true);
  add(map, room(6.0, 1.0, 0.7, false));
  add(map, random_points(rng, 60, 10.0, 4.0, 2.5));
  return map;
}

}  // namespace glocal::test::rooms_in_space
