// A robot pose that is looked for again in the next step.
#pragma once

#include "glocal/pose3.hpp"
#include "glocal/step_result.hpp"

namespace glocal::raters {

/// Whether two estimates may be of one robot pose: drift of a step and the spread of a cluster stay below.
[[nodiscard]] inline bool are_same(const Pose3& a, const Pose3& b) {
  constexpr double distance_m = 0.5;
  constexpr double rotation_deg = 15.0;
  return distance(a, b) < distance_m && rotation_between(a, b) < radians(rotation_deg);
}

/// A robot pose in the map as of one step, with what tells how the robot moves from there.
struct FollowedPose {
  Pose3 map_from_robot;
  Pose3 local_from_robot;
  int epoch = 0;
  double stamp = 0.0;  ///< s

  static FollowedPose of(const StepResult& step, const Pose3& map_from_robot) {
    return {map_from_robot, step.local_from_robot, step.local_map_epoch, step.stamp};
  }

  /// Whether a pose of a later step may be this one, moved by the local motion; not in another local frame.
  [[nodiscard]] bool may_be(const Pose3& pose, const StepResult& step) const {
    return epoch == step.local_map_epoch &&
           are_same(pose, map_from_robot * (inverse(local_from_robot) * step.local_from_robot));
  }

  /// How fast the robot has turned since, rad/s; 0 where no time has passed, or in another local frame.
  [[nodiscard]] double turn_rate_to(const StepResult& step) const {
    const double seconds = step.stamp - stamp;
    return seconds > 0.0 && epoch == step.local_map_epoch
               ? rotation_between(local_from_robot, step.local_from_robot) / seconds
               : 0.0;
  }
};

}  // namespace glocal::raters
