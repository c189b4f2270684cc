// Writing to disk for good.
#pragma once

#include <filesystem>
#include <string_view>

namespace glocal {

/// Appends to a file, which is made if there is none. Throws RunError naming `shown`, what the user knows the
/// file by.
void append_to_file(const std::filesystem::path& file, std::string_view content,
                    const std::filesystem::path& shown);

/// Waits until a file or folder is on the disk. Throws RunError.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace glocal
