// What a recorded drive is, as its files tell.
#pragma once

#include <filesystem>
#include <string>

namespace glocal::app {

enum class LogKind { recording, clouds, carmen };

/// Throws ConfigError if there is neither such a file nor such a folder.
void expect_there(const std::filesystem::path& path);

/// What a drive is read as. Files that are nothing else are taken to be CARMEN logs. Throws ConfigError if
/// nothing is there, and for folders without clouds or parts of recordings.
[[nodiscard]] LogKind kind_of_log(const std::filesystem::path& log);

/// The file of odometry in a folder of clouds; empty if there is none.
[[nodiscard]] std::filesystem::path odometry_of_clouds(const std::filesystem::path& folder);

/// A name for an experiment: what is before the first dot of a file's name or a folder's, at most 80 letters,
/// digits, '_' and '-'; "drive" if there is nothing.
[[nodiscard]] std::string plain_name(const std::filesystem::path& log);

/// Reference poses of a recording are named by a topic, which begins with a slash, or a frame of tf.
[[nodiscard]] inline bool is_topic(const std::string& name) {
  return name.starts_with('/');
}

}  // namespace glocal::app
