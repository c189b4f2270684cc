// Described structs as YAML.
#pragma once

#include <map>
#include <string>

#include "config/node.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// Every field with its value, in the order of the description, in block style. All numbers must be finite.
/// `comments` are of fields with plain values, by path as "localizer.contact_epsilon".
[[nodiscard]] std::string write_yaml(AnyParams& params,
                                     const std::map<std::string, std::string>& comments = {});

/// A node on one line, as it could be given with --set.
[[nodiscard]] std::string flow_yaml(const YamlNode& node);

}  // namespace glocal
