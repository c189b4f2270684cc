// What a finished trial gives to the files of the whole run.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluation/results/summary.hpp"

namespace glocal {

struct JournalEntry {
  std::size_t trial = 0;
  TrialFigures figures;
  std::string trial_line;  ///< Of trials.jsonl.
  std::string step_lines;  ///< Of steps.jsonl; empty if they are not written.
};

/// As an object of JSON, and back. The latter throws a std::exception where it is not as the former makes it.
[[nodiscard]] nlohmann::ordered_json to_json(const JournalEntry& entry);
[[nodiscard]] JournalEntry entry_of(const nlohmann::ordered_json& json);

}  // namespace glocal
