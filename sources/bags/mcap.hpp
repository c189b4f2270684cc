// MCAP recordings, version 0 of the format (mcap.dev/spec).
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "sources/bags/recording_file.hpp"

namespace glocal::bags {

[[nodiscard]] bool is_mcap(std::string_view beginning);

/// Opens a recording, with summary or without, in chunks (uncompressed, lz4, zstd) or not. Chunks' CRC-32 are
/// checked where they are given. See Recording.
[[nodiscard]] std::unique_ptr<RecordingFile> open_mcap(const std::filesystem::path& file,
                                                       const Reading& reading);

}  // namespace glocal::bags
