// Hits on what moves along with the robot.
#pragma once

#include <optional>
#include <vector>

#include "glocal/observation.hpp"
#include "local_mappers/range_profile.hpp"

namespace glocal::local_mappers {

/// Finds what is near and stays where it is as seen from the robot while odometry says that the robot drives:
/// a part of the robot, a cart, somebody who walks beside it. Such hits are nowhere on the map, and they tell
/// a scan matcher that the robot stands still.
class MovingAlong {
 public:
  /// Takes in the next observation. For each of its hits, whether it moves along.
  [[nodiscard]] std::vector<bool> update(const Observation& observation);
  void reset() { before_.reset(); }

 private:
  struct Seen {
    Pose2 odom_from_robot;
    RangeProfile all;
    RangeProfile moving_along;  ///< Of its hits that move along.
  };
  std::optional<Seen> before_;
};

}  // namespace glocal::local_mappers
