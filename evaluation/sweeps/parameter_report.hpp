// What each parameter does, in words, and as data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "evaluation/results/report_blocks.hpp"
#include "evaluation/sweeps/analysis.hpp"

namespace glocal {

/// A share of 1 in percentage points.
[[nodiscard]] std::string points(double share);
/// "8.5", or "-" where no trial was right.
[[nodiscard]] std::string steps_cell(const std::optional<double>& median_steps);

/// A table for each parameter, and, if there is a map, one of right trials and one of steps.
[[nodiscard]] Report parameter_report(const ParameterFigures& figures);

/// `effects`, and `map` if there is one; docs/file-formats.md tells the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const ParameterFigures& figures);

}  // namespace glocal
