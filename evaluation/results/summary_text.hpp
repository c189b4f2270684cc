// The figures of runs for people to read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace glocal {

/// The main figures of a run, of its summary.json: lines that end.
[[nodiscard]] std::string summary_text(const nlohmann::ordered_json& summary);

/// Names of variants and their summaries: a line each, below a head.
[[nodiscard]] std::string variants_text(
    const std::vector<std::pair<std::string, nlohmann::ordered_json>>& variants);

}  // namespace glocal
