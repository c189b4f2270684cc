// What is kept of each finished trial until the run is over, so that a run that is killed can be gone on
// with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/summary.hpp"

namespace glocal {

/// A finished trial, as it goes into the files of the whole run.
struct JournalEntry {
  std::size_t trial = 0;
  TrialFigures figures;
  std::string trial_line;                            ///< Of trials.jsonl.
  std::string step_lines;                            ///< Of steps.jsonl; empty if they are not written.
  std::map<std::string, std::uintmax_t> files = {};  ///< What the trial left in files of its own, bytes.
};

/// Where a results folder has the journal.
inline constexpr const char* journal_folder = "journal";

/// Adds a file to the journal, which appears there when it is whole.
void write_entry(OutputFolder& folder, const JournalEntry& entry);

/// None if the trial is not in the journal of this folder, if its entry is damaged, or if a file of its own
/// is not there in full length.
[[nodiscard]] std::optional<JournalEntry> read_entry(const std::filesystem::path& folder, std::size_t trial);

}  // namespace glocal
