// Robots' own recordings as drives that are passed on, and the other way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sources/bags/drive_contents.hpp"
#include "sources/bags/mcap_writer.hpp"
#include "sources/bags/recording.hpp"
#include "sources/conversion/drive_stream.hpp"

namespace glocal::conversion {

/// The scans of a recording. Memory holds its poses, and of its scans the stamps. Scans at whose time it is
/// not known where the robot or its sensor was, and those that cannot be read, are left out, with a warning
/// at the end.
class RecordingDriveReader final : public DriveReader {
 public:
  /// Throws ConfigError where Recording and bags::read_contents() do.
  RecordingDriveReader(
      const std::filesystem::path& path, const bags::DriveTopics& topics, bags::Damage damage, Warn warn,
      TellProgress progress = [](double) {});

  [[nodiscard]] std::optional<DriveScan> next() override;

 private:
  [[nodiscard]] std::optional<DriveScan> scan_of(const bags::RecordedMessage& message);
  void warn_of_lost();

  std::string file_;
  Warn warn_;
  bags::Recording recording_;
  bags::DriveContents contents_;
  std::size_t without_pose_ = 0, unreadable_ = 0;
};

/// Writes an MCAP recording as ROS 2 makes them: scans and clouds, the robot in odom and its sensors by tf,
/// reference poses as geometry_msgs/PoseStamped of the robot in map on /reference.
class McapDriveWriter final : public DriveWriter {
 public:
  McapDriveWriter(std::vector<DriveSensor> sensors, bags::McapWriter::Sink sink);

  void write(const DriveScan& scan) override;
  void finish() override { writer_.finish(); }

 private:
  void write_fixed_poses(std::int64_t stamp_ns);

  std::vector<DriveSensor> sensors_;
  bags::McapWriter writer_;
  bool has_begun_ = false;
};

}  // namespace glocal::conversion
