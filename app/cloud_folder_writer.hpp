// Drives of clouds, written as a folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "evaluation/results/output_folder.hpp"
#include "sources/conversion/drive_stream.hpp"

namespace glocal::app {

/// Writes a PCD file for each cloud, in the sensor's frame and named by its stamp in seconds, and the robot's
/// poses as odometry.tum and, where there are any, reference.tum. Times of points are left out.
class CloudFolderWriter final : public conversion::DriveWriter {
 public:
  /// `file`: where the drive comes from, for what is said of it. `below`: the folder's part to write to.
  CloudFolderWriter(OutputFolder& folder, std::string file, std::filesystem::path below = {})
      : folder_(folder), file_(std::move(file)), below_(std::move(below)) {}

  /// Throws ConfigError for planar scans, and for a sensor that moves on the robot.
  void write(const conversion::DriveScan& scan) override;
  void finish() override {}

  /// Of the clouds that were written, of which there is one.
  [[nodiscard]] const Pose3& robot_from_sensor() const { return *robot_from_sensor_; }

 private:
  OutputFolder& folder_;
  std::string file_;
  std::filesystem::path below_;
  std::optional<Pose3> robot_from_sensor_;
};

/// The sensor's place as experiments have it: "{x: 0.1, y: 0, …}".
[[nodiscard]] std::string mount_yaml(const Pose3& robot_from_sensor);

}  // namespace glocal::app
