// Whole files, decompressed on the way in.
#pragma once

#include <filesystem>
#include <string>

namespace glocal {

/// The content of a file; gzip, bzip2 and xz are recognised by what the file begins with, not by its name.
/// Throws ConfigError if the file cannot be read, or if its compressed data is damaged or ends early.
[[nodiscard]] std::string read_decompressed(const std::filesystem::path& file);

}  // namespace glocal
