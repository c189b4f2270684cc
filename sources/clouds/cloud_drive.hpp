// Drives recorded as clouds of points, a file for each.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/clouds/cloud.hpp"
#include "sources/clouds/drive_clouds.hpp"
#include "sources/driven_path.hpp"

namespace glocal::clouds {

/// Where a sensor is on its robot.
struct SensorMount {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;
};
void describe(ParamVisitor& v, SensorMount& p);
/// Rolled about x first, then pitched about y, then turned about z.
[[nodiscard]] Pose3 robot_from_sensor(const SensorMount& mount);

/// Without odometry each cloud is a drive of its own.
class CloudDrive final : public ObservationSource {
 public:
  struct Params {
    FilePath folder;
    FilePath odometry;
    FilePath reference;
    std::string poses_of = "robot";
    SensorMount sensor;
    PathSegments segments{{0.0, 1.0}};
    KeyframeRule keyframes;
    double max_range = 100.0;
    double voxel_size = 0.1;
    double unit = 1.0;
    std::string stamp_of = "first_point";
  };

  /// Finds the clouds and their poses; see drive_clouds() for what it throws. Clouds are read when their turn
  /// comes.
  CloudDrive(const Params& params, const SourceSetup& setup);

  /// Throws ConfigError if the cloud is none.
  [[nodiscard]] std::optional<Sample> next() override;

 private:
  [[nodiscard]] Scan scan_of(const Cloud& cloud) const;
  /// Those of the segments that are keyframes.
  [[nodiscard]] std::vector<DriveCloud> picked(const std::vector<DriveCloud>& clouds) const;

  Params params_;
  Warn warn_;
  bool has_warned_ = false;  ///< Of clouds without points.
  Pose3 robot_from_sensor_;
  std::vector<DriveCloud> clouds_;  ///< Those that are used, with poses of the robot.
  std::size_t next_ = 0;
};
void describe(ParamVisitor& v, CloudDrive::Params& p);

}  // namespace glocal::clouds
