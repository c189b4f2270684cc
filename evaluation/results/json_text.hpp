// JSON that is not known to be harmless.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace glocal {

/// As the library of JSON reads it, but throws std::invalid_argument where it is nested deeper than anything
/// glocal writes: copying such a tree would end the program.
[[nodiscard]] nlohmann::ordered_json parse_json(const std::string& text);

/// What an exception says, without the name that the library of JSON puts in front.
[[nodiscard]] std::string reason(const std::exception& error);

}  // namespace glocal
