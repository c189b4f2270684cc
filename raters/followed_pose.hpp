// A robot pose that is looked for again in the next step.
#pragma once

#include <optional>

#include "glocal/pose2.hpp"
#include "glocal/step_result.hpp"

namespace glocal {

/// A robot pose in the map as of one step, with what tells how the robot moves from there.
struct FollowedPose {
  Pose2 map_from_robot;
  Pose2 local_from_robot;
  int generation = 0;

  static FollowedPose of(const StepResult& step, const Pose2& map_from_robot) {
    return {map_from_robot, step.local_from_robot, step.local_map_generation};
  }

  /// Where it is by a later step: moved by the local motion. None in another local frame.
  [[nodiscard]] std::optional<Pose2> expected_in(const StepResult& step) const {
    if (generation != step.local_map_generation) return std::nullopt;
    return map_from_robot * (inverse(local_from_robot) * step.local_from_robot);
  }
};

/// Nearer to each other, and turned by less, than this.
[[nodiscard]] inline bool are_same(const Pose2& a, const Pose2& b, double distance_m, double rotation_deg) {
  return distance(a, b) < distance_m && rotation_between(a, b) < radians(rotation_deg);
}

}  // namespace glocal
