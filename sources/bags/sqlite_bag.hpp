// ROS 2 bags in SQLite (rosbag2_storage_sqlite3: tables `topics` and `messages`).
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "sources/bags/recording_file.hpp"

namespace glocal::bags {

[[nodiscard]] bool is_sqlite(std::string_view beginning);

/// Opens a .db3 file, read-only. See Recording.
[[nodiscard]] std::unique_ptr<RecordingFile> open_sqlite_bag(const std::filesystem::path& file,
                                                             const Reading& reading);

}  // namespace glocal::bags
