// Proportions with their 95 % intervals, as text and as data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluation/statistics/statistics.hpp"

namespace glocal {

/// "83.3 (60.8 to 94.2)": in per cent.
[[nodiscard]] std::string per_cent(const Proportion& proportion);

/// `value`, `low` and `high`, as shares of 1.
[[nodiscard]] nlohmann::ordered_json to_json(const Proportion& proportion);

}  // namespace glocal
