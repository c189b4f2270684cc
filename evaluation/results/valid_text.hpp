// Text that may be written.
#pragma once

#include <string>

namespace glocal {

/// The text in UTF-8: what is not, as plugins may say anything, is replaced by U+FFFD.
[[nodiscard]] std::string valid_utf8(const std::string& text);

}  // namespace glocal
