// What glocal run has left in a folder, read again. docs/file-formats.md says what is in it.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/running/trials.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// Whether glocal run has left this folder, complete or interrupted: whether it has a provenance.json.
[[nodiscard]] bool is_results_folder(const std::filesystem::path& folder);

/// What summary.json says of the run: false if it was interrupted. None if there is no such file, or a
/// damaged one.
[[nodiscard]] std::optional<bool> is_complete(const std::filesystem::path& folder);

/// Where on a drive a trial starts: the same in all runs over the same observations.
struct TrialStart {
  std::int64_t sample = 0;
  double distance_m = 0.0;  ///< Along the drive.
  double stamp = 0.0;

  friend auto operator<=>(const TrialStart&, const TrialStart&) = default;  // NOLINT(modernize-use-nullptr)
};

/// One line of trials.jsonl, with what steps.jsonl says of its time.
struct TrialResult {
  Outcome outcome = Outcome::undecided;
  std::optional<Pose3> start_reference;
  double steps = 0.0;       ///< Up to the declaration; all of them if there is none.
  double distance_m = 0.0;  ///< Driven in these steps.
  std::optional<double> translation_error_m, rotation_error_deg;  ///< Of the declared pose.
  /// Of processors: median over its steps; none where steps were not written, or by a version that did not
  /// measure it.
  std::optional<double> step_cpu_ms;
};

/// A value of effective.yaml. Files are the same if their content is, wherever they lie.
struct Setting {
  std::string text;
  std::string identity;  ///< The text, or the hash of the file it names.
  friend bool operator==(const Setting&, const Setting&) = default;
};

/// The machine that times were taken on, and what it did besides.
struct Machine {
  std::string host, cpu;
  int threads = 1;
  std::size_t jobs = 1;  ///< Trials that ran side by side; 0 where these were not always as many.
  /// Processors that others kept busy meanwhile, in the mean; none if not known.
  std::optional<double> others_load = {};
  friend bool operator==(const Machine&, const Machine&) = default;
};

struct StoredRun {
  std::filesystem::path folder;  ///< As given.
  std::string experiment;        ///< Its name.
  std::uint64_t seed = 0;
  bool complete = true;                     ///< False if the run was interrupted.
  bool has_steps = true;                    ///< Steps were written.
  std::map<std::string, Setting> settings;  ///< By path: "map.simulation.resolution".
  Machine machine;
  std::map<TrialStart, TrialResult> trials;
  nlohmann::ordered_json summary, provenance;  ///< The whole files.
};

/// Who wants more of the lines of trials.jsonl and steps.jsonl than a StoredRun holds: is handed each of
/// them, in their order, all trials before the first step; of a step as much as is read. What is wrong with a
/// line they say with a std::exception.
struct LineReaders {
  std::function<void(const nlohmann::ordered_json&)> trial = [](const nlohmann::ordered_json&) {};
  std::function<void(const nlohmann::ordered_json&)> step = [](const nlohmann::ordered_json&) {};
};

/// The times of a line of steps.jsonl: those of `key`, `stage_ms` or `stage_cpu_ms`. Throws a std::exception
/// where they are not as glocal run writes them.
[[nodiscard]] StageTimes stage_times(const nlohmann::ordered_json& step, const char* key = "stage_ms");

/// The values of an experiment as YAML, by path; `hashes` are those of the input files. `file` is where it
/// comes from, for faults. Throws ConfigError.
[[nodiscard]] std::map<std::string, Setting> settings_of(const std::string& yaml,
                                                         const std::filesystem::path& file,
                                                         const std::map<std::string, std::string>& hashes);

/// The same of a folder's effective.yaml, which must be whole.
[[nodiscard]] std::map<std::string, Setting> read_settings(const std::filesystem::path& folder,
                                                           const std::map<std::string, std::string>& hashes);

/// What of a folder is read: steps are most of it.
enum class ResultParts {
  all,
  times,  ///< Of steps only the beginnings of their lines, which hold their times and are a tenth of them.
  all_but_steps,
};

/// Reads a results folder. Throws ConfigError with every fault of it: files that are missing, cut off or
/// damaged, trials and steps that are not all there, keys of earlier versions.
[[nodiscard]] StoredRun read_results(const std::filesystem::path& folder, const LineReaders& also = {},
                                     ResultParts parts = ResultParts::all);

/// Throws ConfigError if a run has left no steps, which this is about.
void require_steps(const StoredRun& run);

/// The results folder that `path` is, or those in it, in the order of their file (variants.json) or else by
/// name, in which numbers count as numbers (hidden ones left out). Those count,
/// too, that have lost their provenance.json, of which read_results() tells. Throws ConfigError if there is
/// none.
[[nodiscard]] std::vector<std::filesystem::path> results_folders(const std::filesystem::path& path);

}  // namespace glocal
