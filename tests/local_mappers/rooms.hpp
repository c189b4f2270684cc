// Rooms made of straight walls, and exact scans of them.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "glocal/observation.hpp"
#include "glocal/rng.hpp"

namespace glocal::test {

/// A wall from (x0, y0) to (x1, y1), m.
using Wall = std::array<double, 4>;

/// A room of 12 m x 8 m with a pillar and a niche, which looks the same from no two places.
inline std::vector<Wall> furnished_room() {
  return {{0, 0, 12, 0},    {12, 0, 12, 8},   {12, 8, 7, 8},    {7, 8, 7, 9},     {7, 9, 5.5, 9},
          {5.5, 9, 5.5, 8}, {5.5, 8, 0, 8},   {0, 8, 0, 0},     {4, 3, 5, 3.2},   {5, 3.2, 4.8, 4},
          {4.8, 4, 4, 3},   {8.5, 5, 9.5, 5}, {9.5, 5, 9.5, 6}, {9.5, 6, 8.5, 6}, {8.5, 6, 8.5, 5}};
}

/// Two bare parallel walls, 2 m apart and 200 m long.
inline std::vector<Wall> bare_corridor() {
  return {{-100, -1, 100, -1}, {-100, 1, 100, 1}};
}

/// Distance along a ray to a wall, by Cramer's rule.
inline std::optional<double> ray_length(const Pose2& ray, const Wall& wall) {
  const double dx = std::cos(ray.theta), dy = std::sin(ray.theta);
  const double wx = wall[2] - wall[0], wy = wall[3] - wall[1];
  const double det = dx * wy - dy * wx;
  if (std::abs(det) < 1e-12) return std::nullopt;
  const double ox = wall[0] - ray.x, oy = wall[1] - ray.y;
  const double along_ray = (ox * wy - oy * wx) / det;
  const double along_wall = (ox * dy - oy * dx) / det;
  if (along_ray <= 0.0 || along_wall < 0.0 || along_wall > 1.0) return std::nullopt;
  return along_ray;
}

struct Laser {
  int beams = 361;
  double field_of_view = std::numbers::pi;  ///< rad
  double max_range = 20.0;                  ///< m
  double noise = 0.0;                       ///< Standard deviation of a range, m.
};

/// The scan of a laser at the robot's origin.
inline Scan scan_from(const std::vector<Wall>& walls, const Pose2& map_from_robot, const Laser& laser,
                      Rng& rng) {
  Scan scan;
  for (int i = 0; i < laser.beams; ++i) {
    const double angle = laser.field_of_view * (static_cast<double>(i) / (laser.beams - 1) - 0.5);
    double range = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
      range = std::min(range, ray_length(map_from_robot * Pose2{0, 0, angle}, wall).value_or(range));
    }
    if (range > laser.max_range) continue;
    if (laser.noise > 0.0) range += rng.normal(laser.noise);
    scan.hits.push_back(
        {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0});
  }
  return scan;
}

/// Beams in every direction, half a degree apart, that all end after `range` m.
inline Scan circle_around(const Point& origin, float range) {
  Scan scan;
  scan.origin = origin;
  for (int i = 0; i < 720; ++i) {
    const float angle = static_cast<float>((i + 0.25) * std::numbers::pi / 360.0);
    scan.hits.push_back({origin.x + range * std::cos(angle), origin.y + range * std::sin(angle), 0.0F});
  }
  return scan;
}

}  // namespace glocal::test
