#include "evaluation/results/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "config/reader.hpp"
#include "config/text_file.hpp"
#include "config/yaml_parser.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const fs::path& file, std::size_t line, const std::string& what) {
  throw ConfigError({{file.string(), static_cast<int>(line), 0, what}});
}

void check_readable(const fs::path& file) {
  if (why_unreadable(file)) refuse(file, 0, "cannot be read; name a folder that glocal run has left");
}

std::optional<double> number(const Json& line, const char* key) {
  if (!line.contains(key)) return std::nullopt;
  return line.at(key).get<double>();
}

TrialResult trial_of(const Json& line) {
  TrialResult trial;
  trial.outcome = outcome_of(line.at("outcome"));
  if (line.at("start").contains("reference")) {
    const Json& pose = line.at("start").at("reference");
    trial.start_reference = Pose2{pose.at("x"), pose.at("y"), pose.at("theta")};
  }
  trial.steps = line.at("steps");
  trial.distance_m = line.at("distance_m");
  trial.translation_error_m = number(line, "translation_error_m");
  trial.rotation_error_deg = number(line, "rotation_error_deg");
  return trial;
}

/// Median time of a step, ms, by the trial's number. Empty where no steps were written.
std::map<std::size_t, double> step_times(const fs::path& file) {
  std::map<std::size_t, std::vector<double>> ms;
  if (fs::exists(file)) {
    for_each_line(file, [&](const Json& step) {
      const Json& stages = step.at("stage_ms");
      double total = 0.0;
      for (const char* stage : {"local_map", "match", "cluster", "rate"})
        total += stages.at(stage).get<double>();
      ms[step.at("trial")].push_back(total);
    });
  }
  std::map<std::size_t, double> medians;
  for (auto& [trial, values] : ms) medians[trial] = quantile(std::move(values), 0.5);
  return medians;
}

void read_trials(StoredRun& results) {
  const std::map<std::size_t, double> times = step_times(results.folder / "steps.jsonl");
  const fs::path file = results.folder / "trials.jsonl";
  for_each_line(file, [&](const Json& line) {
    TrialResult trial = trial_of(line);
    const auto time = times.find(line.at("trial"));
    if (time != times.end()) trial.step_ms = time->second;
    const Json& start = line.at("start");
    const TrialStart at{start.at("sample"), start.at("distance_m"), start.at("stamp")};
    if (!results.trials.emplace(at, trial).second) {
      throw std::invalid_argument("an earlier trial starts at the same place");
    }
  });
}

/// All scalars of a tree by path. Lists are counted from 0: "map.log_map.segments[0][1]".
void flatten(const YamlNode& node, const std::string& path, const std::map<std::string, std::string>& hashes,
             std::map<std::string, Setting>& settings) {
  for (const YamlEntry& entry : node.entries) {
    flatten(entry.value, path.empty() ? entry.key : path + "." + entry.key, hashes, settings);
  }
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    flatten(node.items[i], fmt::format("{}[{}]", path, i), hashes, settings);
  }
  if (node.kind != NodeKind::scalar) return;
  const auto hash = hashes.find(node.text);
  settings[path] = {node.text, hash == hashes.end() ? node.text : hash->second};
}

bool holds_results(const fs::path& folder) {
  return fs::exists(folder / "summary.json") || fs::exists(folder / "trials.jsonl");
}

}  // namespace

void with_json(const fs::path& file, const std::function<void(const Json&)>& work) {
  check_readable(file);
  try {
    work(Json::parse(std::ifstream(file)));
  } catch (const std::exception& error) {
    refuse(file, 0,
           fmt::format("is not as glocal run leaves it ({}); run the experiment again", error.what()));
  }
}

void for_each_line(const fs::path& file, const std::function<void(const Json&)>& work) {
  check_readable(file);
  std::ifstream stream(file);
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    try {
      work(Json::parse(line));
    } catch (const std::exception& error) {
      refuse(file, number, fmt::format("is no line of results ({}); run the experiment again", error.what()));
    }
  }
}

std::map<std::string, Setting> read_settings(const fs::path& folder,
                                             const std::map<std::string, std::string>& hashes) {
  const fs::path file = folder / "effective.yaml";
  check_readable(file);
  std::vector<Fault> faults;
  const auto tree = parse_yaml(read_text_file(file), origin_of(file), faults);
  if (!faults.empty()) throw ConfigError(std::move(faults));
  std::map<std::string, Setting> settings;
  flatten(*tree, "", hashes, settings);
  return settings;
}

StoredRun read_results(const fs::path& folder) {
  StoredRun results;
  results.folder = folder;
  with_json(folder / "summary.json", [&](const Json& summary) {
    results.experiment = summary.at("name");
    results.seed = summary.at("seed");
    results.complete = summary.at("complete");
  });
  std::map<std::string, std::string> hashes;
  with_json(folder / "provenance.json", [&](const Json& provenance) {
    results.machine = {provenance.at("host"), provenance.at("cpu"), provenance.at("threads")};
    hashes = provenance.at("inputs_sha256");
  });
  results.settings = read_settings(folder, hashes);
  read_trials(results);
  return results;
}

std::vector<fs::path> results_folders(const fs::path& path) {
  std::error_code unreachable;
  if (!fs::is_directory(path, unreachable))
    refuse(path, 0, "is no folder; name a folder that glocal run has left");
  if (holds_results(path)) return {path};
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(path)) {
    const bool is_hidden = entry.path().filename().string().starts_with('.');
    if (entry.is_directory() && !is_hidden && holds_results(entry.path())) folders.push_back(entry.path());
  }
  if (folders.empty()) {
    refuse(
        path, 0,
        "holds no results: there is no summary.json, neither here nor in a folder below; name a folder that "
        "glocal run has left");
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace glocal
