// What is put together from journals: the files of a whole run.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/results/journal_entry.hpp"
#include "evaluation/results/journal_scan.hpp"
#include "evaluation/results/output_folder.hpp"

namespace glocal {

/// All trials of a variant, and what journals have of them.
class JournaledTrials {
 public:
  /// `variant` is as identity_of() tells; `samples` are those that its trials start at. The scan must stay.
  JournaledTrials(const JournalScan& scan, std::string variant, std::vector<std::size_t> samples)
      : scan_(scan), variant_(std::move(variant)), samples_(std::move(samples)) {}

  [[nodiscard]] std::size_t count() const { return samples_.size(); }
  /// Numbers of those that have not come to an end, ascending.
  [[nodiscard]] std::vector<std::size_t> missing() const;
  /// What a trial has left, its own files written to the folder; none if it is missing. Throws a
  /// std::exception where it is not as a journal has it.
  std::optional<JournalEntry> take(std::size_t trial, OutputFolder& folder) const;
  /// Adds to the provenance of a process those that have finished trials already: all hosts and processors,
  /// and how many threads a trial had and how many trials ran side by side; 0 where these were not always as
  /// many.
  void tell_processes(nlohmann::ordered_json& provenance) const;

 private:
  [[nodiscard]] TrialId id(std::size_t trial) const { return trial_id(variant_, trial, samples_[trial]); }

  const JournalScan& scan_;
  std::string variant_;
  std::vector<std::size_t> samples_;
};

/// Writes effective.yaml and provenance.json: what tells which run this is. `description` is as
/// VariantRun::description() makes it.
void write_origin(OutputFolder& folder, const nlohmann::ordered_json& description);

/// Writes trials.jsonl and, if asked, steps.jsonl, all files of trials, and last summary.json, which is
/// returned. When this returns, all is on the disk.
[[nodiscard]] nlohmann::ordered_json put_together(OutputFolder& folder,
                                                  const nlohmann::ordered_json& description,
                                                  const JournaledTrials& trials, bool complete);

}  // namespace glocal
