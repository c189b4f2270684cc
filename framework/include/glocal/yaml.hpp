// Described structs from YAML files, strictly.
#pragma once

#include <filesystem>

#include "glocal/params.hpp"

namespace glocal {

/// Fills a described struct from a YAML file. Unknown or duplicate keys, wrong types, values out of range,
/// merge keys and trailing documents are errors; all of them are reported in one ConfigError with
/// file:line:column.
void read_yaml(const std::filesystem::path& file, AnyParams& params);

}  // namespace glocal
