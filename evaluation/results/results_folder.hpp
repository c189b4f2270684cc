// What glocal run has left in a folder, read again. docs/file-formats.md says what is in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "evaluation/running/trials.hpp"
#include "glocal/pose2.hpp"

namespace glocal {

/// Hands over the content of a file of JSON. Throws ConfigError for one that is none, or that `work` cannot
/// make sense of: then it throws a std::exception.
void with_json(const std::filesystem::path& file,
               const std::function<void(const nlohmann::ordered_json&)>& work);

/// Hands over each line of a file of JSON lines. Throws ConfigError naming the line that is none, or that
/// `work` cannot make sense of: then it throws a std::exception.
void for_each_line(const std::filesystem::path& file,
                   const std::function<void(const nlohmann::ordered_json&)>& work);

/// Where on a drive a trial starts: the same in all runs over the same observations.
struct TrialStart {
  std::int64_t sample = 0;
  double distance_m = 0.0;  ///< Along the drive.
  double stamp = 0.0;
  friend bool operator<(const TrialStart& a, const TrialStart& b) {
    return std::tie(a.sample, a.distance_m, a.stamp) < std::tie(b.sample, b.distance_m, b.stamp);
  }
};

/// One line of trials.jsonl, with what steps.jsonl says of its time.
struct TrialResult {
  Outcome outcome = Outcome::undecided;
  std::optional<Pose2> start_reference;
  double steps = 0.0;       ///< Up to the declaration; all of them if there is none.
  double distance_m = 0.0;  ///< Driven in these steps.
  std::optional<double> translation_error_m, rotation_error_deg;  ///< Of the declared pose.
  std::optional<double> step_ms;  ///< Median over its steps; none where steps were not written.
};

/// A value of effective.yaml. Files are the same if their content is, wherever they lie.
struct Setting {
  std::string text;
  std::string identity;  ///< The text, or the hash of the file it names.
};

/// The machine that times were taken on.
struct Machine {
  std::string host, cpu;
  int threads = 1;
  friend bool operator==(const Machine&, const Machine&) = default;
};

struct StoredRun {
  std::filesystem::path folder;  ///< As given.
  std::string experiment;        ///< Its name.
  std::uint64_t seed = 0;
  bool complete = true;                     ///< False if the run was interrupted.
  std::map<std::string, Setting> settings;  ///< By path: "map.simulation.resolution".
  Machine machine;
  std::map<TrialStart, TrialResult> trials;
};

/// The values of effective.yaml by path; `hashes` are those of the input files. Throws ConfigError.
[[nodiscard]] std::map<std::string, Setting> read_settings(const std::filesystem::path& folder,
                                                           const std::map<std::string, std::string>& hashes);

/// Throws ConfigError for what is not there, or not as glocal run leaves it.
[[nodiscard]] StoredRun read_results(const std::filesystem::path& folder);

/// The results folder that `path` is, or those in it, sorted by name (hidden ones left out). Throws
/// ConfigError if there is none.
[[nodiscard]] std::vector<std::filesystem::path> results_folders(const std::filesystem::path& path);

}  // namespace glocal
