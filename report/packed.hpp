// Data as short text, which is what keeps reports small.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glocal {

/// JSON, compressed (zlib, RFC 1950), in base64 (RFC 4648): a quarter of its length. What is not UTF-8 in it,
/// such as names of folders may have, is replaced. The same data give the same text.
[[nodiscard]] std::string packed(const nlohmann::ordered_json& data);

}  // namespace glocal
