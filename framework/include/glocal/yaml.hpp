// Described structs from YAML files, strictly, and text for such files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "glocal/params.hpp"

namespace glocal {

/// What becomes of keys that a struct does not describe: files of other programs may have more than is asked
/// for.
enum class OtherKeys { refused, passed_over };

/// Fills a described struct from a YAML file. Unknown or duplicate keys, wrong types, values out of range,
/// merge keys and trailing documents are errors; all of them are reported in one ConfigError with
/// file:line:column.
void read_yaml(const std::filesystem::path& file, AnyParams& params,
               OtherKeys other_keys = OtherKeys::refused);

/// Text as a value in YAML: quoted unless it is a plain word.
[[nodiscard]] std::string to_yaml(std::string_view value);

}  // namespace glocal
