// Described structs as YAML.
#pragma once

#include <string>

#include "glocal/params.hpp"

namespace glocal {

/// Every field with its value, in the order of the description, in block style. All numbers must be finite.
[[nodiscard]] std::string write_yaml(AnyParams& params);

}  // namespace glocal
