// JSON that is not known to be harmless.
#pragma once

#include <cstddef>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>

namespace glocal {

/// As the library of JSON reads it, but throws std::invalid_argument where it is nested deeper than anything
/// glocal writes: copying such a tree would end the program.
[[nodiscard]] nlohmann::ordered_json parse_json(const std::string& text);

/// The whole number from 0 on that an object has under a key, or an array at an index. Throws
/// std::invalid_argument for others, which the library of JSON would make one of.
[[nodiscard]] std::size_t whole_number(const nlohmann::ordered_json& object, const char* key);
[[nodiscard]] std::size_t whole_number(const nlohmann::ordered_json& array, std::size_t index);

/// What an exception says, without the name that the library of JSON puts in front.
[[nodiscard]] std::string reason(const std::exception& error);

}  // namespace glocal
