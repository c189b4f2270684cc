// Entries of the leaderboard, from folders of results and from runs in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "evaluation/leaderboard/board_entry.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/experiment_loader.hpp"

namespace glocal {

/// All of an experiment's values that the answer of a method follows from.
[[nodiscard]] std::string hash_of_method(const std::map<std::string, Setting>& settings);

/// The entries of all methods whose results on a suite lie in a folder, each with all its cases and seeds as
/// far as they are there. Throws ConfigError for damaged results, for those that are not complete, and where
/// there is none that was run with --suite.
[[nodiscard]] std::vector<BoardEntry> entries_of_folder(const std::filesystem::path& folder);

/// Runs a variant's trials and keeps what an entry has of them, but for times. Throws ConfigError.
[[nodiscard]] CaseResult run_in_memory(const Variant& variant, LoadedExperiment& loaded,
                                       const Catalog& catalog);

/// A line for each start that both have and whose stored result is not the same as that of `fresh`: where it
/// is, what is stored and what is there now.
[[nodiscard]] std::vector<std::string> differences(const CaseResult& stored, const CaseResult& fresh);

/// What a method has come to at the starts that it has before and now: a report in plain sentences.
[[nodiscard]] std::string paired_text(const BoardEntry& before, const BoardEntry& now);

}  // namespace glocal
