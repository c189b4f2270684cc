// Drives through rooms, with odometry that is wrong.
#pragma once

#include <cmath>
#include <vector>

#include "local_mappers/rooms.hpp"

namespace glocal::test {

/// A drive with the truth about it.
struct Drive {
  std::vector<Observation> observations;
  std::vector<Pose2> map_from_robot;
};

struct OdometryFault {
  double turn_per_m = 0.0;      ///< rad
  double scale = 1.0;           ///< Of distances.
  double noise_per_step = 0.0;  ///< Standard deviation, m and a third of it in rad.
};

/// Poses 0.2 m apart on a circle of radius 2 m around the pillar of the furnished room.
inline std::vector<Pose2> circle(int steps) {
  std::vector<Pose2> poses;
  for (int i = 0; i < steps; ++i) {
    const double angle = 0.1 * i;
    poses.push_back(
        {4.5 + 2.0 * std::cos(angle), 3.5 + 2.0 * std::sin(angle), wrap_angle(angle + radians(90))});
  }
  return poses;
}

inline Drive drive(const std::vector<Wall>& walls, const std::vector<Pose2>& poses, const Laser& laser,
                   const OdometryFault& fault) {
  Rng rng(11);
  Drive result;
  Pose2 odom{3.0, -2.0, 1.0};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) {
      Pose2 step = inverse(poses[i - 1]) * poses[i];
      step.theta += fault.turn_per_m * std::hypot(step.x, step.y) + rng.normal(fault.noise_per_step / 3.0);
      step.x = step.x * fault.scale + rng.normal(fault.noise_per_step);
      step.y = step.y * fault.scale + rng.normal(fault.noise_per_step);
      odom = odom * step;
    }
    result.observations.push_back({0.0, scan_from(walls, poses[i], laser, rng), odom});
    result.map_from_robot.push_back(poses[i]);
  }
  return result;
}

/// The wheels turn 3.4 degrees per metre too much, as on one of the real robots.
inline constexpr OdometryFault bad_odometry{.turn_per_m = 0.06, .scale = 1.05, .noise_per_step = 0.01};

/// An observation with odometry along x, in m.
inline Observation at(double odom_x, const std::vector<Point>& hits) {
  Observation observation;
  observation.odom_from_robot.x = odom_x;
  for (const Point& p : hits) observation.scan.hits.push_back(p);
  return observation;
}

/// Somebody carries the robot to a place that looks different; odometry does not notice.
inline Drive kidnapping() {
  Drive result = drive(furnished_room(), circle(10), {}, {});
  const std::vector<Wall> closet{{-1, -0.6, 1.2, -0.6}, {1.2, -0.6, 1.2, 0.7}, {1.2, 0.7, -1, 0.7}};
  Rng rng(5);
  for (int i = 0; i < 4; ++i) {
    Observation observation = result.observations.back();
    observation.scan = scan_from(closet, {0, 0, 0}, {}, rng);
    result.observations.push_back(observation);
  }
  return result;
}

}  // namespace glocal::test
