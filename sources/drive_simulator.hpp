// A robot's drive through a simulated world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/rng.hpp"
#include "sources/carmen_parser.hpp"
#include "sources/laser.hpp"
#include "sources/world.hpp"

namespace glocal {

/// Each step's motion is measured with an error that always is the same and one that is drawn anew.
struct OdometryParams {
  double distance_bias = 0.01;
  double distance_noise = 0.02;
  double turn_bias = 0.01;
  double turn_noise = 0.02;
  double yaw_bias_deg_per_m = 0.2;
  double yaw_noise_deg_per_m = 0.5;
};
void describe(ParamVisitor& v, OdometryParams& p);

struct DriveParams {
  FilePath world;
  double step_length = 0.6;
  double step_turn_deg = 45.0;
  double step_seconds = 1.0;
  LaserParams laser;
  OdometryParams odometry;
};
void describe(ParamVisitor& v, DriveParams& p);

/// Robot poses along straight ways between places, with turns on the spot; no step is longer than `length`
/// (m) or turns by more than `turn` (rad).
[[nodiscard]] std::vector<Pose2> drive_poses(const std::vector<Position>& way_points, double length,
                                             double turn);

class DriveSimulator {
 public:
  /// Throws ConfigError where read_world() does.
  DriveSimulator(const DriveParams& params, std::uint64_t seed);

  /// The scan of the next step, with its reference pose; none at the end of the drive. Rays that meet nothing
  /// within the laser's range read max_range.
  [[nodiscard]] std::optional<CarmenScan> next();

 private:
  [[nodiscard]] CarmenScan measure(const Pose2& map_from_robot, double time) const;
  [[nodiscard]] Pose2 measured_motion(const Pose2& from, const Pose2& to) const;

  DriveParams params_;
  World world_;
  Shapes reality_;
  std::vector<Pose2> poses_;
  Rng rng_;
  std::size_t step_ = 0;
  Pose2 odom_from_robot_;
};

}  // namespace glocal
