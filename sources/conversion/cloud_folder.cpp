#include "sources/conversion/cloud_folder.hpp"

#include <utility>

#include "glocal/error.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::conversion {

CloudFolderReader::CloudFolderReader(const clouds::DriveFiles& files, const Warn& warn, TellProgress progress)
    : clouds_(clouds::drive_clouds(files, warn)), progress_(std::move(progress)) {
  sensors_ = {{"/points", "lidar", true, Pose3{}}};
  for (const clouds::DriveCloud& cloud : clouds_) {
    if (!cloud.odometry)
      throw ConfigError(files.folder,
                        "has no odometry.tum, and a recording says where the robot was at each scan; give "
                        "the file with --odometry");
    check_stamp(cloud.stamp, cloud.file.string());
  }
}

std::optional<DriveScan> CloudFolderReader::next() {
  progress_(static_cast<double>(next_) / static_cast<double>(clouds_.size()));
  if (next_ == clouds_.size()) return std::nullopt;
  const clouds::DriveCloud& source = clouds_[next_++];
  clouds::Cloud cloud = clouds::read_cloud(source.file, {.is_scan = true});
  DriveScan scan;
  scan.stamp_ns = nanoseconds_of(source.stamp);
  scan.odom_from_robot = *source.odometry;
  scan.map_from_robot = source.reference;
  scan.rays = bags::PointCloud{{scan.stamp_ns, sensors_.front().frame},
                               std::move(cloud.points),
                               std::move(cloud.times),
                               cloud.not_finite};
  return scan;
}

}  // namespace glocal::conversion
