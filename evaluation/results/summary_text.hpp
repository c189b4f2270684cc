// The figures of runs for people to read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace glocal {

/// The main figures of a run, of its summary.json: lines that end.
[[nodiscard]] std::string summary_text(const nlohmann::ordered_json& summary);

/// Of a summary's trials: how many are undecided, with those that count neither as right nor as wrong for
/// other reasons.
[[nodiscard]] std::string undecided_cell(const nlohmann::ordered_json& trials);

/// Names of variants and their summaries: a line each, below a head.
[[nodiscard]] std::string variants_text(
    const std::vector<std::pair<std::string, nlohmann::ordered_json>>& variants);

}  // namespace glocal
