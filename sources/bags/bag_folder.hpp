// Folders of ROS 2 recordings: which files belong to one, and what its metadata.yaml says of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace glocal::bags {

struct BagFolder {
  std::vector<std::filesystem::path> files;  ///< Not empty; as metadata.yaml lists them, or by their names.
  /// Messages of each topic, as metadata.yaml has them; empty without.
  std::map<std::string, std::uint64_t> messages;
  std::vector<std::string> warnings;
};

/// Whether a folder is one: it has files of recordings, perhaps compressed, or a metadata.yaml of one.
[[nodiscard]] bool is_bag_folder(const std::filesystem::path& folder);

/// Throws ConfigError, with what to do, for a folder that is none, a metadata.yaml that cannot be read, files
/// that it names and that are not there, and files that are compressed as a whole.
[[nodiscard]] BagFolder read_bag_folder(const std::filesystem::path& folder);

}  // namespace glocal::bags
