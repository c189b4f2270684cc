// Single values: from YAML, strictly, and into YAML, so that they come back the same.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/node.hpp"
#include "glocal/params.hpp"
#include "glocal/yaml.hpp"

namespace glocal {

/// Why a value was refused; none if it was taken.
using Refusal = std::optional<std::string>;

/// Each takes a value from a node, or says why not and leaves the value alone. Numbers are decimal, finite
/// and within the field's bounds; `true` and `false` are the only truth values; quoted text is never a number
/// or a truth value.
[[nodiscard]] Refusal take_value(const YamlNode& node, const FieldInfo& info, bool& value);
[[nodiscard]] Refusal take_value(const YamlNode& node, const FieldInfo& info, int& value);
[[nodiscard]] Refusal take_value(const YamlNode& node, const FieldInfo& info, std::uint64_t& value);
[[nodiscard]] Refusal take_value(const YamlNode& node, const FieldInfo& info, double& value);
/// A number, or `auto`.
[[nodiscard]] Refusal take_value(const YamlNode& node, const FieldInfo& info, std::optional<double>& value);
[[nodiscard]] Refusal take_value(const YamlNode& node, const FieldInfo& info, std::string& value);
/// Paths are relative to the folder of the node's origin; `data:` stands for the folder in GLOCAL_DATASETS.
/// The file must be there, unless the path is empty and not required.
[[nodiscard]] Refusal take_value(const YamlNode& node, const FieldInfo& info, FilePath& value);

/// "> 0 m", ">= 1 and <= 256"; empty without bounds.
[[nodiscard]] std::string bounds_text(const FieldInfo& info);

/// "2 items", "at least 1 item", "1 to 3 items"; empty if a list may have any number of them.
[[nodiscard]] std::string count_text(const FieldInfo& info);
/// "1 item", "2 items".
[[nodiscard]] std::string counted(std::size_t n);

[[nodiscard]] std::string to_yaml(bool value);
[[nodiscard]] std::string to_yaml(int value);
[[nodiscard]] std::string to_yaml(std::uint64_t value);
/// The shortest text that reads back as the same number. Finite numbers only.
[[nodiscard]] std::string to_yaml(double value);
/// `auto` for none.
[[nodiscard]] std::string to_yaml(const std::optional<double>& value);
/// `data:` paths as written, all others absolute.
[[nodiscard]] std::string to_yaml(const FilePath& value);

}  // namespace glocal
