// What the robot perceives in one step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// One range scan in the robot's frame, m. Of a scan that was made in motion, each hit is as measured: in the
/// robot's frame at the hit's own time.
struct Scan {
  Points hits;       ///< Ends of the rays that met something, in beam order.
  Points free_ends;  ///< Ends of rays that met nothing: the way from `origin` to there is free.
  Point origin;      ///< The sensor, where all rays begin.
  /// When each hit was measured, s after the observation's stamp; empty if all are of one moment, or nobody
  /// knows.
  std::vector<float> times = {};
};

/// One step's input. Odometry counts from an arbitrary start and drifts; only its increments mean something,
/// and, where the motion is upright, which way is up: along its z axis.
struct Observation {
  double stamp = 0.0;  ///< s; may stand still or run backwards in real logs, so never divide by differences.
  Scan scan;
  Pose3 odom_from_robot;
};

/// An observation with what only the evaluation may see.
struct Sample {
  Observation observation;
  std::optional<Pose3> map_from_robot;  ///< Reference pose, if the source has one.
  int segment = 0;                      ///< Changes where the drive is interrupted: no trial runs across.
  std::string map = {};  ///< That the reference pose is on, in its frame, where there are several.
};

}  // namespace glocal
