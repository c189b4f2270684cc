// What files of MCAP consist of, for those who read and who write them (mcap.dev/spec).
#pragma once

#include <cstdint>
#include <string_view>

namespace glocal::bags {

/// What a file begins and ends with.
inline constexpr std::string_view mcap_mark("\x89MCAP0\r\n", 8);

/// A record's first byte; eight follow with the size of its fields.
enum class McapOp : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  summary_offset = 14,
  data_end = 15
};

}  // namespace glocal::bags
