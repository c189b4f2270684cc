// Folders of clouds as drives that are passed on.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sources/clouds/drive_clouds.hpp"
#include "sources/conversion/drive_stream.hpp"

namespace glocal::conversion {

/// The clouds of a folder, one after the other, as /points in the frame `lidar`. Their sensor is taken to be
/// where the robot is; poses are as in the files.
class CloudFolderReader final : public DriveReader {
 public:
  /// Throws ConfigError where clouds::drive_clouds() does, for a drive without odometry, and for stamps that
  /// are before 1970 or after 2037.
  CloudFolderReader(
      const clouds::DriveFiles& files, const Warn& warn, TellProgress progress = [](double) {});

  /// Throws ConfigError where clouds::read_cloud() does.
  [[nodiscard]] std::optional<DriveScan> next() override;

 private:
  std::vector<clouds::DriveCloud> clouds_;
  std::size_t next_ = 0;
  TellProgress progress_;
};

}  // namespace glocal::conversion
