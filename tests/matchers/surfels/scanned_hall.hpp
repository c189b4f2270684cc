// A hall with things in it, and what a lidar sees of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "boxes.hpp"
#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal::test {

/// A hall of 14 m x 9 m x 4 m without any symmetry; its first box is seen from inside.
inline std::vector<Box> hall() {
  return {{{0.0, 0.0, 0.0}, {14.0, 9.0, 4.0}}, {{2.0, 1.0, 0.0}, {3.0, 4.0, 2.5}},
          {{6.0, 6.0, 0.0}, {9.0, 7.0, 1.5}},  {{10.0, 2.0, 0.0}, {11.5, 3.0, 3.0}},
          {{0.0, 6.5, 0.0}, {1.5, 9.0, 3.2}},  {{12.5, 6.0, 0.0}, {14.0, 7.2, 2.0}},
          {{5.0, 0.0, 2.2}, {8.0, 0.8, 4.0}}};
}

/// How far a ray reaches, m: from inside the first box, and outside all others.
inline double range_of_ray(const std::vector<Box>& boxes, const Vector3& from, const Vector3& direction) {
  double range = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto [enter, leave] = crossing(boxes[i], from, direction);
    if (i == 0) {
      range = leave;
    } else if (enter > 0.0 && enter < leave) {
      range = std::min(range, enter);
    }
  }
  return range;
}

/// The cloud of a lidar with 32 beams, in its own frame, m.
inline Points scan_of(const std::vector<Box>& boxes, const Pose3& hall_from_lidar) {
  Points cloud;
  for (int beam = -16; beam < 16; ++beam) {
    for (int azimuth = 0; azimuth < 360; azimuth += 2) {
      // Off the axes by a little: no division by zero.
      const double up = radians(2.0 * beam + 1.013);
      const double around = radians(azimuth + 0.517);
      const Vector3 ray{std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
      const double range = range_of_ray(boxes, hall_from_lidar.translation(), hall_from_lidar.rotation * ray);
      const Vector3 hit = range * ray;
      cloud.push_back(as_point(hit));
    }
  }
  return cloud;
}

}  // namespace glocal::test
