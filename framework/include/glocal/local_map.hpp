// The map a robot builds of its surroundings while it localizes.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// Points of all observations so far, in the local frame: the robot's pose when this map was started,
/// without its tilt where the motion is upright.
struct LocalMap {
  Points points;
  Points normals;          ///< Unit normals of `points`, or empty; (0, 0, 0) where a point has none.
  Pose3 local_from_robot;  ///< Where the robot is now.
  /// Observation k of this map registered the points [ends[k-1], ends[k]), with ends[-1] = 0: those that the
  /// map did not have. `iransac` draws from the latest.
  std::vector<std::size_t> ends;
  /// Counts up whenever the mapper starts over with a new frame; poses in the old frame mean nothing any
  /// more.
  int epoch = 0;
};

}  // namespace glocal
