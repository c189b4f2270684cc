// What is kept of each finished trial until the run is over, so that a run that is killed can be gone on
// with.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/summary.hpp"

namespace glocal {

/// A finished trial, as it goes into the files of the whole run.
struct JournalEntry {
  std::size_t trial = 0;
  TrialFigures figures;
  std::string trial_line;                         ///< Of trials.jsonl.
  std::string step_lines;                         ///< Of steps.jsonl; empty if they are not written.
  std::map<std::string, std::string> files = {};  ///< What the trial left in files of its own: checksums.
};

/// As an object of JSON, and back. The latter throws a std::exception where it is not as the former makes it.
[[nodiscard]] nlohmann::ordered_json to_json(const JournalEntry& entry);
[[nodiscard]] JournalEntry entry_of(const nlohmann::ordered_json& json);

/// Where a results folder has the journal.
inline constexpr const char* journal_folder = "journal";

/// CRC-32 as 8 hexadecimal digits, as gzip and zip have it.
[[nodiscard]] std::string checksum(std::string_view bytes);

/// What stands behind its checksum and a space; none if the checksum is another one's.
[[nodiscard]] std::optional<std::string_view> checked_content(std::string_view text);

/// Where the entry of a trial is, in a results folder.
[[nodiscard]] std::filesystem::path entry_name(std::size_t trial);

/// Adds a file to the journal. When this returns, the trial is on the disk for good, with its own files.
void write_entry(OutputFolder& folder, const JournalEntry& entry);

/// None if the trial is not in the journal of this folder. Throws RunError with file and line if its entry
/// is damaged, or if a file of its own is not there as it was.
[[nodiscard]] std::optional<JournalEntry> read_entry(const std::filesystem::path& folder, std::size_t trial);

}  // namespace glocal
