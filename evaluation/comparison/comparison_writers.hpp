// A comparison for programs to read: docs/file-formats.md says what is in it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluation/comparison/comparison.hpp"

namespace glocal {

/// All of it.
[[nodiscard]] nlohmann::ordered_json to_json(const Comparison& comparison);

/// One row for each variant and test.
[[nodiscard]] std::string to_csv(const Comparison& comparison);

}  // namespace glocal
