// The clouds of a drive: a folder of files, and the poses that belong to them.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/pose3.hpp"

namespace glocal::clouds {

/// A cloud's file, and what is known of it.
struct DriveCloud {
  std::filesystem::path file;
  double stamp = 0.0;              ///< s; the number at the end of its name, else its place in the order.
  std::optional<Pose3> odometry;   ///< As in the file of odometry; all clouds have one, or none.
  std::optional<Pose3> reference;  ///< As in the file of reference poses.
  int segment = 0;                 ///< Part of the drive that it belongs to.
};

/// Where the parts of a drive are.
struct DriveFiles {
  std::filesystem::path folder;          ///< With the clouds; other files are passed over.
  std::filesystem::path odometry = {};   ///< Trajectory; empty if there is none.
  std::filesystem::path reference = {};  ///< Trajectory; empty if there is none.
};

/// The number at the end of a cloud's name, as a stamp (s): of 17 digits or more, nanoseconds. None if there
/// is none.
[[nodiscard]] std::optional<double> stamp_in_name(const std::filesystem::path& file);

/// The clouds in the order of their stamps if all have a number, else of their names. Poses with stamps go to
/// the clouds of the nearest stamp. Where no stamp is near, or there are none, the first pose is that of the
/// first cloud, and so on. Throws ConfigError for a folder without clouds, two clouds with the same number,
/// odometry that leaves out a cloud, and poses that belong to no cloud. Warns of clouds without reference.
[[nodiscard]] std::vector<DriveCloud> drive_clouds(const DriveFiles& files, const Warn& warn);

}  // namespace glocal::clouds
