// Simulated observations of a lidar, in space.
#pragma once

#include <optional>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/simulation/drive_params.hpp"
#include "sources/simulation/driving_robot.hpp"
#include "sources/simulation/scene.hpp"

namespace glocal::simulation {

/// A drive through a simulated world with a lidar. The robot's frame is the sensor's: a height over the
/// floor, rolled and pitched as the robot sways. Odometry measures x, y and yaw as that of a planar drive
/// does; its height stands still, as the floor is level, and its roll and pitch are measured by gravity.
class LidarSimulation final : public ObservationSource {
 public:
  using Params = LidarDriveParams;
  static constexpr Motions motions = motions_in_space;

  /// Throws ConfigError where planned_drive() does, for a sensor above the ceiling, and for a drive through
  /// the world's cloud.
  LidarSimulation(const Params& params, const SourceSetup& setup);

  [[nodiscard]] std::optional<Sample> next() override;

 private:
  LidarSimulation(const Params& params, const SourceSetup& setup, PlannedDrive drive);

  /// Where the sensor is, `time` seconds (0 or less) after a step.
  [[nodiscard]] Pose3 pose_at(const DriveStep& step, double time) const;
  [[nodiscard]] Pose3 odometry(const DriveStep& step) const;
  void check_height() const;
  void check_ways() const;

  LidarParams lidar_;
  double step_seconds_;
  std::string file_;  ///< Of the world.
  World world_;
  Scene scene_;
  DrivingRobot robot_;
  Swaying swaying_;
};

}  // namespace glocal::simulation
