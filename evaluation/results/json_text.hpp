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

/// JSON as text; `indent` is as of nlohmann::json. What is not UTF-8 in it, such as names of files may have,
/// is replaced by U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// The text in UTF-8: what is not, as plugins may say anything, is replaced in the same way.
[[nodiscard]] std::string valid_utf8(const std::string& text);

/// What an exception says, without the name that the library of JSON puts in front.
[[nodiscard]] std::string reason(const std::exception& error);

}  // namespace glocal
