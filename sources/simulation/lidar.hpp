// A simulated lidar of several beams that turns about its upright axis.
#pragma once

#include <functional>
#include <vector>

#include "glocal/observation.hpp"
#include "glocal/params.hpp"
#include "glocal/pose3.hpp"
#include "glocal/rng.hpp"

namespace glocal::simulation {

/// How a lidar measures, and how it is carried about. The defaults are much like a Velodyne
/// VLP-16 on a robot of medium height.
struct LidarParams {
  int beams = 16;
  std::vector<double> vertical_fov_deg = {-15.0, 15.0};
  double azimuth_step_deg = 0.8;
  double min_range = 0.5;  ///< m; what is nearer is not seen. Not in YAML.
  double max_range = 30.0;
  double noise = 0.02;
  /// Share of hits whose range is anything between min_range and max_range, and share of hits that are lost:
  /// more of both are disturbances. Not in YAML.
  double outliers = 0.01;
  double dropped = 0.03;
  double height = 1.0;
  double tilt_deg = 3.0;  ///< Roll and pitch sway smoothly within so much. Not in YAML.
  /// Standard deviation of roll and pitch as odometry has them: by gravity, so that they do not drift. Not in
  /// YAML.
  double tilt_noise_deg = 0.1;
  double scan_time = 0.0;
};
void describe(ParamVisitor& v, LidarParams& p);

/// Distance (m) from a place on the map along a unit vector to what a ray meets: infinite if it meets
/// nothing.
using SpatialRayDistance = std::function<double(const Vector3& origin, const Vector3& direction)>;

/// Where the lidar is on the map, `time` seconds after the end of its turn.
using LidarPath = std::function<Pose3(double time)>;

/// What the lidar measures in one turn, in its own frame at the time of each ray: x is forward and z is up.
/// It begins looking backwards and turns to the left, with all beams at once. Rays that meet nothing within
/// the range give nothing, as dropped ones do, so that nothing is said to be free. Hits have times if
/// scan_time is above 0.
[[nodiscard]] Scan lidar_scan(const LidarParams& lidar, const LidarPath& map_from_lidar,
                              const SpatialRayDistance& ray_distance, Rng rng);

/// A roll and a pitch that change smoothly from step to step, each within `tilt_deg`, as on uneven ground: a
/// sum of three waves of 10 to 50 steps.
class Swaying {
 public:
  Swaying(double tilt_deg, Rng rng);

  /// `steps` since the start, whole or not.
  [[nodiscard]] Quaternion at(double steps) const;

 private:
  struct Wave {
    double size;       ///< rad
    double frequency;  ///< rad for each step
    double phase;      ///< rad
  };
  std::vector<Wave> roll_;
  std::vector<Wave> pitch_;
};

}  // namespace glocal::simulation
