// LZF, the compression of PCD files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace glocal {

/// What was compressed; none if the data is damaged or does not make up `size` bytes. Memory grows with what
/// the data really holds.
[[nodiscard]] std::optional<std::string> lzf_decompressed(std::string_view data, std::size_t size);

}  // namespace glocal
