// ROS 1 bags, version 2.0 (wiki.ros.org/Bags/Format/2.0).
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "sources/bags/recording_file.hpp"

namespace glocal::bags {

/// Whether a file that begins so is a bag of ROS 1, of whatever version.
[[nodiscard]] bool is_ros1_bag(std::string_view beginning);

/// Opens a bag, indexed or not; chunks are uncompressed, bz2 or lz4. See Recording.
[[nodiscard]] std::unique_ptr<RecordingFile> open_ros1_bag(const std::filesystem::path& file,
                                                           const Reading& reading);

}  // namespace glocal::bags
