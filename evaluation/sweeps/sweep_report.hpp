// What is learned from a sweep, in words, and as data.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/sweeps/analysis.hpp"

namespace glocal {

/// What a reader of the numbers must know, a sentence each: what is missing, how the best was chosen, how
/// much of its lead may be chance, and which number to report.
[[nodiscard]] std::vector<std::string> warnings_of(const SweepAnalysis& analysis);

/// For a terminal, with at most so many settings.
[[nodiscard]] std::string text_report(const SweepAnalysis& analysis, std::size_t most_settings);

/// All numbers; docs/file-formats.md tells the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const SweepAnalysis& analysis);
/// The same as text, with the end of its last line.
[[nodiscard]] std::string json_text(const SweepAnalysis& analysis);

}  // namespace glocal
