// Compressed chunks of recordings.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sources/bags/file_bytes.hpp"

namespace glocal::bags {

/// Larger chunks are refused. The usual ones have 1 to 10 MB.
inline constexpr std::uint64_t largest_chunk = 256ULL << 20U;

/// The bytes of a chunk. `compression`: none (also ""), bz2, lz4 (the frame format) or zstd. Memory grows
/// with what is really unpacked, up to `size`, which is announced. `spare` is memory to unpack into, as that
/// of an earlier chunk; what is in it does not count. Throws ConfigError for other compressions, damaged
/// data, and data that does not unpack to `size` bytes or is larger than `largest_chunk`.
[[nodiscard]] std::string unpacked(std::string_view compression, std::string_view packed, std::uint64_t size,
                                   const Place& place, std::string spare = {});

/// Whether bytes begin as a Zstandard frame, which CDR never does.
[[nodiscard]] bool is_zstd(std::string_view beginning);

/// A message of ROS 2 that was compressed by itself: a Zstandard frame that says its size. Throws ConfigError
/// as unpacked() does.
[[nodiscard]] std::string unpacked_message(std::string_view packed, const Place& place);

}  // namespace glocal::bags
