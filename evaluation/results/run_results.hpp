// What a run leaves in its folder: trials as they end, and the files of all at the end.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/journal.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/trial_output.hpp"

namespace glocal {

/// Numbers of so many trials that are not in the folder's journal, ascending. Drops what is damaged in there,
/// and hands `warn` a sentence on it.
[[nodiscard]] std::vector<std::size_t> missing_trials(const OutputFolder& folder, std::size_t trials,
                                                      const std::function<void(const std::string&)>& warn);

/// Writes what a trial has left, from any thread; it need not be run again from here on, whatever happens.
void keep_trial(OutputFolder& folder, TrialOutput output);

/// Writes effective.yaml and provenance.json: what tells which run this is. `description` is as
/// VariantRun::description() makes it.
void write_origin(OutputFolder& folder, const nlohmann::ordered_json& description);

/// Writes trials.jsonl and, if asked, steps.jsonl of a run with so many trials, and last summary.json, which
/// is returned. `entry_of` gives the entry of a trial; none if the trial is missing. Files of trials are not
/// touched.
[[nodiscard]] nlohmann::ordered_json put_together(
    OutputFolder& folder, const nlohmann::ordered_json& description, std::size_t trials, bool complete,
    const std::function<std::optional<JournalEntry>(std::size_t trial)>& entry_of);

}  // namespace glocal
