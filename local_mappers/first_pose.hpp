// Where the robot is when a local map is begun.
#pragma once

#include "glocal/motion.hpp"
#include "glocal/pose3.hpp"

namespace glocal::local_mappers {

/// The first local_from_robot of a map: no turn at all; where the motion is upright, the tilt that odometry
/// has, so that up is up in the local frame. The heading is 0 then.
[[nodiscard]] inline Pose3 first_pose(const Pose3& odom_from_robot, Motion motion) {
  if (motion != Motion::upright) return {};
  return Pose3(composed(turn_about_z(-odom_from_robot.heading()), odom_from_robot.rotation));
}

}  // namespace glocal::local_mappers
