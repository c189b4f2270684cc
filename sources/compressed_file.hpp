// Whole files, decompressed on the way in.
#pragma once

#include <filesystem>
#include <string>

namespace glocal {

/// What fits into the memory of most machines; no log or map image at hand has a tenth of it.
inline constexpr double default_max_size_gb = 2.0;

/// The content of a file; gzip, bzip2 and xz are recognised by what the file begins with, not by its name.
/// Throws ConfigError if the file cannot be read, if its compressed data is damaged or ends early, or if it
/// has more than max_size_gb (10^9 bytes), decompressed.
[[nodiscard]] std::string read_decompressed(const std::filesystem::path& file,
                                            double max_size_gb = default_max_size_gb);

}  // namespace glocal
