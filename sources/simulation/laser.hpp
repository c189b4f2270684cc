// A simulated range finder: what it measures, and how its scans are to be read.
#pragma once

#include <functional>

#include "glocal/params.hpp"
#include "glocal/rng.hpp"
#include "sources/carmen/carmen_parser.hpp"
#include "sources/carmen/log_drive.hpp"
#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// The defaults are a Sick LMS 200 in its 8 m mode.
struct LaserParams {
  double fov_deg = 180.0;
  double step_deg = 0.5;
  double max_range = 8.0;
  double noise = 0.01;
  double outliers = 0.0;  ///< Share of readings that are anything between 0 and max_range. Not in YAML.
  /// Where it is in the robot's frame, m, and where it looks. Not in YAML.
  double x = 0.0, y = 0.0, yaw_deg = 0.0;
};
void describe(ParamVisitor& v, LaserParams& p);

/// Distance (m) from a place on the map along a unit vector to what a ray meets: infinite if it meets
/// nothing, not a number if nobody knows.
using RayDistance = std::function<double(const Position& origin, const Position& direction)>;

/// What the laser measures from a robot pose. Rays that meet nothing within its range read max_range, those
/// of which nothing is known 0. Stamp and odometry are left to the caller.
[[nodiscard]] carmen::CarmenScan simulated_scan(const LaserParams& laser, const Pose2& map_from_robot,
                                                const RayDistance& ray_distance, Rng rng);

/// How a log of such scans is to be read: every scan is used, and what a simulated laser does not see within
/// its range is not there.
[[nodiscard]] carmen::LogParams scan_limits(const LaserParams& laser);

}  // namespace glocal::simulation
