// Files that are taken for experiments and are something else.
#pragma once

#include <optional>
#include <string>

#include "config/node.hpp"

namespace glocal {

/// What a file is where an experiment is expected, and how it is used, in a sentence; none if it looks like
/// an experiment, or like nothing that is known.
[[nodiscard]] std::optional<std::string> why_no_experiment(const YamlNode& tree);

}  // namespace glocal
