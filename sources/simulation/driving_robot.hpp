// A robot on its way through a simulated world, or through a map: where it is, and where odometry says it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "glocal/rng.hpp"
#include "sources/simulation/drive_params.hpp"
#include "sources/simulation/planned_drive.hpp"

namespace glocal::simulation {

/// Where the robot is when it measures.
struct DriveStep {
  std::size_t number = 0;  ///< From 0.
  double stamp = 0.0;      ///< s
  Pose2 map_from_robot;
  std::optional<Pose2> map_from_last;  ///< The robot a step before; none where it did not drive from there.
  Pose2 odom_from_robot;
};

/// A robot on its way, in the plane.
class DrivingRobot {
 public:
  DrivingRobot(Route route, const DriveParams& params, std::uint64_t seed);

  /// The next step; none at the end of the drive.
  [[nodiscard]] std::optional<DriveStep> next();
  void start_over();
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

}  // namespace glocal::simulation
