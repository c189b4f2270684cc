// A robot's drive through a simulated world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/rng.hpp"
#include "sources/carmen_parser.hpp"
#include "sources/laser.hpp"
#include "sources/lidar.hpp"
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

/// Somebody carries the robot away, and its wheels do not notice.
struct Kidnapping {
  double after_m = 0.0;
  std::vector<double> to;
  double heading_deg = 0.0;
};
void describe(ParamVisitor& v, Kidnapping& p);

struct DriveParams {
  FilePath world;
  int tour_legs = 0;
  std::vector<Kidnapping> kidnappings;
  double step_length = 0.6;
  double step_turn_deg = 45.0;
  double step_seconds = 1.0;
  LaserParams laser;
  LidarParams lidar;
  OdometryParams odometry;
};
void describe(ParamVisitor& v, DriveParams& p);

/// The robot's poses, one for each observation.
struct Route {
  std::vector<Pose2> poses;
  std::vector<std::size_t> carried;  ///< Those the robot was carried to, by their indexes.
};

/// Straight ways between places, with turns on the spot. Throws ConfigError for a kidnapping to where the
/// drive cannot go on, or after its end.
[[nodiscard]] Route route_of(const World& world, const DriveParams& params, Rng rng);

/// Streams of random numbers, one for each thing that is drawn on a drive.
enum class DriveStream : std::uint64_t { laser, odometry, tour, lidar, sway, tilt };

/// Where the robot is when it measures.
struct DriveStep {
  std::size_t number = 0;  ///< From 0.
  double stamp = 0.0;      ///< s
  Pose2 map_from_robot;
  std::optional<Pose2> map_from_last;  ///< The robot a step before; none where it did not drive from there.
  Pose2 odom_from_robot;
};

/// A robot on its way through a world, in the plane.
class DrivingRobot {
 public:
  /// Throws ConfigError where route_of() does.
  DrivingRobot(const World& world, const DriveParams& params, std::uint64_t seed);

  /// The next step; none at the end of the drive.
  [[nodiscard]] std::optional<DriveStep> next();
  [[nodiscard]] const Route& route() const { return route_; }
  /// What is drawn for a step.
  [[nodiscard]] Rng stream(DriveStream stream, std::size_t step) const;

 private:
  [[nodiscard]] Pose2 measured_motion(const Pose2& from, const Pose2& to) const;

  OdometryParams odometry_;
  double step_seconds_;
  Rng rng_;
  Route route_;
  std::size_t step_ = 0;
  Pose2 odom_from_robot_;
};

/// A robot with a planar laser.
class DriveSimulator {
 public:
  /// Throws ConfigError where read_world() and route_of() do.
  DriveSimulator(const DriveParams& params, std::uint64_t seed);

  /// The scan of the next step, with its reference pose; none at the end of the drive. Rays that meet nothing
  /// within the laser's range read max_range.
  [[nodiscard]] std::optional<CarmenScan> next();

 private:
  [[nodiscard]] CarmenScan measure(const DriveStep& step) const;

  LaserParams laser_;
  World world_;
  Shapes reality_;
  DrivingRobot robot_;
};

}  // namespace glocal
