// Poses over time from text files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/pose3.hpp"

namespace glocal::clouds {

struct StampedPose {
  double stamp = 0.0;  ///< s; never falls from pose to pose.
  Pose3 pose;
};

struct Trajectory {
  std::vector<StampedPose> poses;  ///< Never empty.
  bool has_stamps = false;         ///< Whether stamps are those of the file; else they are 0, 1, 2 …
};

/// A pose a line, as its number of values tells: 8 are TUM's (stamp tx ty tz qx qy qz qw), 12 KITTI's (the
/// upper three rows of the matrix, row by row). Lines that begin with # are skipped. Throws ConfigError with
/// the line: another number of values, numbers that are none or not finite, places beyond `farthest_m`,
/// quaternions whose length and matrices whose columns are off by more than 1e-3, stamps that fall.
[[nodiscard]] Trajectory parse_trajectory(std::string_view content, const std::string& file);

/// The same for a file, perhaps compressed (gzip, bzip2, xz).
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& file);

}  // namespace glocal::clouds
