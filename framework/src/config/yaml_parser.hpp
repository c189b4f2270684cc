// Strict YAML: one document of maps, lists and scalars, without what surprises.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/node.hpp"

namespace glocal {

/// Parses one document. Duplicate keys, merge keys, anchors, aliases, tags and further documents are faults,
/// and so is a document without content; all that are found before the first syntax error are appended to
/// `faults`. None if there is no tree to go on with.
[[nodiscard]] std::optional<YamlNode> parse_yaml(const std::string& text,
                                                 const std::shared_ptr<const Origin>& origin,
                                                 std::vector<Fault>& faults);

/// Parses the value of an override; its places have no lines, and no value at all is a null node.
[[nodiscard]] std::optional<YamlNode> parse_yaml_value(const std::string& text,
                                                       const std::shared_ptr<const Origin>& origin,
                                                       std::vector<Fault>& faults);

}  // namespace glocal
