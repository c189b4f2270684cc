// A room of boxes, exact scans of it in space, and drives through it with odometry that is wrong.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "boxes.hpp"
#include "glocal/observation.hpp"
#include "glocal/rng.hpp"

namespace glocal::test {

/// A room of 10 m x 7 m x 3 m with two cupboards, a table and a beam under the ceiling.
inline std::vector<Box> furnished_hall() {
  return {{{0, 0, 0}, {10, 7, 3}},
          {{0, 5.5, 0}, {2, 7, 2.2}},
          {{7, 0, 0}, {8, 1.2, 2.5}},
          {{4.5, 3.2, 0.6}, {5.5, 4.0, 0.8}},
          {{6, 0, 2.6}, {6.4, 7, 3}}};
}

/// Distance along a ray to the first face in its way.
inline std::optional<double> ray_length(const Vector3& origin, const Vector3& direction, const Box& box) {
  const auto [enter, leave] = crossing(box, origin, direction);
  if (enter > leave || leave <= 0.0) return std::nullopt;
  return enter > 0.0 ? enter : leave;
}

/// 16 rings within 15 degrees of the level, a ray every 2 degrees; the sensor is at the robot's origin.
/// `noise` is the standard deviation of a range, m.
inline Scan ring_scan(const std::vector<Box>& boxes, const Pose3& map_from_robot, double noise, Rng& rng) {
  Scan scan;
  for (int ring = 0; ring < 16; ++ring) {
    const double elevation = radians(-15.0 + 2.0 * ring);
    for (int ray = 0; ray < 180; ++ray) {
      const double azimuth = radians(2.0 * ray + 0.1);
      const Vector3 direction{std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      const Vector3 in_map = map_from_robot.rotation * direction;
      double range = std::numeric_limits<double>::infinity();
      for (const Box& box : boxes)
        range = std::min(range, ray_length(map_from_robot.translation(), in_map, box).value_or(range));
      const Vector3 hit = (range + rng.normal(noise)) * direction;
      scan.hits.push_back(as_point(hit));
    }
  }
  return scan;
}

/// A drive in space with the truth about it.
struct SpatialDrive {
  std::vector<Observation> observations;
  std::vector<Pose3> map_from_robot;
};

/// Half a metre from scan to scan around the table, on uneven ground. Odometry is 3 % short, turns 1.5
/// degrees too far each metre, and knows the tilt but for 0.1 degrees.
inline SpatialDrive drive_around_table(int steps) {
  Rng rng(7);
  SpatialDrive drive;
  Pose3 odom({2, 1, 0}, exponential({0.02, -0.01, 0.0}));
  for (int i = 0; i < steps; ++i) {
    const double angle = 0.5 * i / 2.2;
    const Vector3 tilt{rng.normal(0.02), rng.normal(0.02), 0.0};
    const Pose3 pose({5.0 + 2.2 * std::cos(angle), 3.5 + 1.8 * std::sin(angle), 1.0 + rng.normal(0.02)},
                     turn_about_z(angle + std::numbers::pi / 2.0) * exponential(tilt));
    if (i == 0) {
      odom = {{2, 1, 0}, exponential(tilt)};
    } else {
      const Pose3 step = inverse(drive.map_from_robot.back()) * pose;
      const double way = step.translation().norm();
      const Vector3 fault{rng.normal(0.002), rng.normal(0.002), radians(1.5) * way};
      odom = odom * Pose3(0.97 * step.translation(), step.rotation * exponential(fault));
    }
    drive.observations.push_back({1.0 * i, ring_scan(furnished_hall(), pose, 0.01, rng), odom});
    drive.map_from_robot.push_back(pose);
  }
  return drive;
}

}  // namespace glocal::test
