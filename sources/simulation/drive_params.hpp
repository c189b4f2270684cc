// Where a simulated robot drives, what has changed there since the map was made, and how it measures.
#pragma once

#include <vector>

#include "glocal/params.hpp"
#include "sources/simulation/laser.hpp"
#include "sources/simulation/lidar.hpp"
#include "sources/simulation/occupancy_ray.hpp"
#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// Noise is of never more standard deviations than this (Rng::normal()), and brings into range what is so far
/// beyond.
constexpr double most_deviations = 9.0;

/// Each step's motion is measured with an error that always is the same and one that is drawn anew: shares of
/// distances and turns, which are not in YAML, and turns that are measured when driving straight.
struct OdometryParams {
  double distance_bias = 0.01;
  double distance_noise = 0.02;  ///< Standard deviation, as of what is drawn below.
  double turn_bias = 0.01;
  double turn_noise = 0.02;
  double yaw_bias_deg_per_m = 0.2;
  double yaw_noise_deg_per_m = 0.5;
};
void describe(ParamVisitor& v, OdometryParams& p);

/// Somebody carries the robot away, and its wheels do not notice.
struct Kidnapping {
  double after_m = 0.0;
  std::vector<double> to;
  double heading_deg = 0.0;
};
void describe(ParamVisitor& v, Kidnapping& p);

/// Of a drive, whatever the robot measures with.
struct DriveParams {
  FilePath world;
  int tour_legs = 0;
  double clearance = 0.3;
  int boxes = 0;
  int people = 0;
  std::vector<Kidnapping> kidnappings;
  double step_length = 0.6;
  double step_turn_deg = 45.0;
  double step_seconds = 1.0;
  OdometryParams odometry;
};

/// With a planar laser, in a world or a map.
struct LaserDriveParams : DriveParams {
  FilePath map;
  std::vector<Position> way_points;
  /// Farthest a ray may go through unknown cells of a map before it reaches an occupied one, m; one that goes
  /// farther gives no reading. Not in YAML.
  double max_unknown = unknown_rim;
  LaserParams laser;
};
void describe(ParamVisitor& v, LaserDriveParams& p);

/// With a lidar, in a world.
struct LidarDriveParams : DriveParams {
  LidarParams lidar;
};
void describe(ParamVisitor& v, LidarDriveParams& p);

}  // namespace glocal::simulation
