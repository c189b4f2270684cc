// Lists of pairs of clouds whose poses are known.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "glocal/pose3.hpp"

namespace glocal::clouds {

/// A line of a list.
struct CloudPair {
  std::string source, target;  ///< As the list names them.
  std::filesystem::path source_file, target_file;
  std::optional<Pose3> target_from_source = {};  ///< The true pose, where the list knows it.
  std::string kind = "all";                      ///< Its column `class`: "easy", "hard" …
};

/// The pairs of a CSV file with a line of names: `source` and `target` (paths relative to the file); perhaps
/// tx ty tz qx qy qz qw, the pose target_from_source (m, unit quaternion), and `class`; other columns are
/// passed over. Throws ConfigError with all faults.
[[nodiscard]] std::vector<CloudPair> read_cloud_pairs(const std::filesystem::path& file);

}  // namespace glocal::clouds
