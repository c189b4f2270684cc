// Whole files: read, and written to disk for good.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace glocal {

/// The bytes of a file; empty if it cannot be read.
[[nodiscard]] std::string content_of(const std::filesystem::path& file);

/// Appends to a file, which is made if there is none. Throws RunError naming `shown`, what the user knows the
/// file by.
void append_to_file(const std::filesystem::path& file, std::string_view content,
                    const std::filesystem::path& shown);

/// Waits until a file or folder is on the disk. Throws RunError.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace glocal
