#include "evaluation/results/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/reader.hpp"
#include "config/text_file.hpp"
#include "config/yaml_parser.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/pose_json.hpp"
#include "evaluation/results/variant_order.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* mark_of_results = "provenance.json";

/// More than an experiment may have.
constexpr std::size_t most_threads = 1000;

constexpr const char* way_out = "run the experiment again with this version";

/// Keys of a step that earlier versions wrote, and what they are called now.
constexpr std::array<std::pair<const char*, const char*>, 2> renamed_keys = {
    {{"collisions", "proposals"}, {"checks", "points_tested"}}};
constexpr std::array<std::pair<const char*, const char*>, 1> renamed_evidence = {
    {{"conflict", "free_space_violation"}}};

[[noreturn]] void refuse(const fs::path& file, std::size_t line, const std::string& what) {
  throw ConfigError({{file.string(), static_cast<int>(line), 0, what}});
}

void check_readable(const fs::path& file) {
  if (why_unreadable(file)) refuse(file, 0, "cannot be read; name a folder that glocal run has left");
}

/// The number of the line in which this byte is.
std::size_t line_at(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  return 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n'));
}

/// Hands over the content of a file of JSON. A std::exception of `work` is a fault of the file.
template <class Work>
void with_json(const fs::path& file, const Work& work) {
  check_readable(file);
  const std::string text = content_of(file);
  const auto fail = [&](std::size_t line, const std::exception& error) {
    refuse(file, line, fmt::format("is not as glocal run leaves it ({}); {}", reason(error), way_out));
  };
  try {
    work(parse_json(text));
  } catch (const Json::parse_error& error) {
    fail(line_at(text, error.byte == 0 ? 0 : error.byte - 1), error);
  } catch (const std::exception& error) {
    fail(0, error);
  }
}

void whole_line(std::string& /*line*/) {}

/// Leaves of a line of steps.jsonl what it begins with, up to its times; all of a line that is not so.
void head_of_step(std::string& line) {
  constexpr std::string_view key = "\"stage_cpu_ms\":{";
  constexpr std::size_t longest = 1000;
  const std::size_t begin = std::string_view(line).substr(0, longest).find(key);
  const std::size_t end = begin == std::string::npos ? begin : line.find('}', begin);
  if (end == std::string::npos || line.back() != '}') return;
  line.resize(end + 1);
  line += '}';
}

/// Hands over each line of a file of JSON lines, as `shorten` leaves it, and tells their number. A
/// std::exception of `work` is a fault of the line.
template <class Work>
std::size_t for_each_line(const fs::path& file, void (*shorten)(std::string&), const Work& work) {
  check_readable(file);
  std::ifstream stream(file);
  std::size_t number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    shorten(line);
    try {
      work(parse_json(line));
    } catch (const std::exception& error) {
      refuse(file, number, fmt::format("is no line of results ({}); {}", reason(error), way_out));
    }
  }
  return number;
}

template <std::size_t n>
void refuse_renamed(const Json& json, const std::array<std::pair<const char*, const char*>, n>& keys) {
  for (const auto& [was, is] : keys) {
    if (json.contains(was))
      throw std::invalid_argument(
          fmt::format("it is of an earlier version: '{}' is called '{}' now", was, is));
  }
}

std::optional<double> number(const Json& line, const char* key) {
  if (!line.contains(key)) return std::nullopt;
  return line.at(key).get<double>();
}

TrialResult trial_of(const Json& line) {
  TrialResult trial;
  trial.outcome = outcome_of(line.at("outcome"));
  if (line.at("start").contains("reference"))
    trial.start_reference = pose_of(line.at("start").at("reference"));
  trial.steps = line.at("steps");
  trial.distance_m = line.at("distance_m");
  trial.translation_error_m = number(line, "translation_error_m");
  trial.rotation_error_deg = number(line, "rotation_error_deg");
  return trial;
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

/// Has, or once had, all of a run.
bool holds_results(const fs::path& folder) {
  std::error_code unreachable;
  return is_results_folder(folder) || fs::exists(folder / "summary.json", unreachable) ||
         fs::exists(folder / "trials.jsonl", unreachable);
}

[[noreturn]] void refuse_to_look(const fs::path& path, const std::error_code& error) {
  refuse(
      path, 0,
      fmt::format("cannot be looked into ({}); make the folder readable, or name another", error.message()));
}

/// The folders in a folder. Throws ConfigError if it cannot be looked into.
std::vector<fs::path> folders_in(const fs::path& path) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unreachable;
    if (entry->is_directory(unreachable)) folders.push_back(entry->path());
  }
  if (error) refuse_to_look(path, error);
  return folders;
}

/// One folder, file by file. What is wrong with one file does not keep the others from being read.
class ResultsReader {
 public:
  ResultsReader(const fs::path& folder, const LineReaders& also) : also_(also) { run_.folder = folder; }

  StoredRun read(ResultParts parts) {
    read_head();
    const bool wants_steps = run_.has_steps && parts != ResultParts::all_but_steps;
    if (faults_.collect([&] { read_trials(); }) && wants_steps)
      faults_.collect([&] { read_steps(parts == ResultParts::times ? head_of_step : whole_line); });
    faults_.report();
    return std::move(run_);
  }

 private:
  struct TrialSteps {
    TrialStart start;
    std::size_t least = 0;  ///< Up to the declaration; there may be more.
    std::size_t steps = 0;  ///< So far.
    std::vector<double> cpu_ms = {};
  };

  void read_head();
  void read_trials();
  void read_steps(void (*shorten)(std::string&));
  void check_all_steps(const fs::path& file, std::size_t lines) const;

  const LineReaders& also_;
  StoredRun run_;
  std::optional<std::size_t> trials_counted_, steps_counted_;  ///< By the summary.
  std::map<std::size_t, TrialSteps> steps_;                    ///< By the trial's number.
  FaultCollector faults_;
};

void ResultsReader::read_head() {
  faults_.collect([&] {
    with_json(run_.folder / "summary.json", [&](const Json& summary) {
      run_.experiment = summary.at("name");
      run_.seed = whole_number(summary, "seed");
      run_.complete = summary.at("complete");
      trials_counted_ = whole_number(summary.at("trials"), "count");
      for (const char* outcome : {"right", "wrong", "undecided"})
        static_cast<void>(whole_number(summary.at("trials"), outcome));
      steps_counted_ = whole_number(summary, "steps");
      if (const auto load = summary.find("others_load"); load != summary.end())
        run_.machine.others_load = load->get<double>();
      run_.summary = summary;
    });
  });
  std::map<std::string, std::string> hashes;
  faults_.collect([&] {
    with_json(run_.folder / mark_of_results, [&](const Json& provenance) {
      run_.machine.host = provenance.at("host");
      run_.machine.cpu = provenance.at("cpu");
      run_.machine.threads =
          static_cast<int>(std::min<std::size_t>(whole_number(provenance, "threads"), most_threads));
      if (provenance.contains("jobs")) run_.machine.jobs = whole_number(provenance, "jobs");
      hashes = provenance.at("inputs_sha256");
      run_.provenance = provenance;
    });
  });
  faults_.collect([&] {
    run_.settings = read_settings(run_.folder, hashes);
    run_.has_steps = run_.settings.at("output.steps").text != "false";
  });
}

void ResultsReader::read_trials() {
  const fs::path file = run_.folder / "trials.jsonl";
  const std::size_t lines = for_each_line(file, whole_line, [&](const Json& line) {
    const std::size_t number = whole_number(line, "trial");
    const Json& start = line.at("start");
    const TrialStart at{static_cast<std::int64_t>(whole_number(start, "sample")), start.at("distance_m"),
                        start.at("stamp")};
    if (!steps_.try_emplace(number, TrialSteps{at, whole_number(line, "steps")}).second)
      throw std::invalid_argument(fmt::format("trial {} is there already", number));
    if (!run_.trials.emplace(at, trial_of(line)).second)
      throw std::invalid_argument("an earlier trial starts at the same place");
    also_.trial(line);
  });
  if (trials_counted_ && *trials_counted_ != lines)
    refuse(file, std::max(lines, std::size_t{1}),
           fmt::format("ends here with {} trials, where summary.json counts {}; {}", lines, *trials_counted_,
                       way_out));
}

void ResultsReader::read_steps(void (*shorten)(std::string&)) {
  const fs::path file = run_.folder / "steps.jsonl";
  const std::size_t lines = for_each_line(file, shorten, [&](const Json& line) {
    const std::size_t number = whole_number(line, "trial");
    const auto trial = steps_.find(number);
    if (trial == steps_.end())
      throw std::invalid_argument(fmt::format("trials.jsonl has no trial {}", number));
    TrialSteps& of_trial = trial->second;
    if (const std::size_t step = whole_number(line, "step"); step != of_trial.steps)
      throw std::invalid_argument(
          fmt::format("step {} of trial {} is here, where step {} belongs", step, number, of_trial.steps));
    refuse_renamed(line, renamed_keys);
    if (line.contains("evidence")) refuse_renamed(line.at("evidence"), renamed_evidence);
    static_cast<void>(stage_times(line));
    if (line.contains("stage_cpu_ms")) of_trial.cpu_ms.push_back(stage_times(line, "stage_cpu_ms").total());
    ++of_trial.steps;
    also_.step(line);
  });
  check_all_steps(file, lines);
  for (auto& [number, trial] : steps_) {
    if (!trial.cpu_ms.empty())
      run_.trials.at(trial.start).step_cpu_ms = quantile(std::move(trial.cpu_ms), 0.5);
  }
}

void ResultsReader::check_all_steps(const fs::path& file, std::size_t lines) const {
  const auto fail = [&](const std::string& what) {
    refuse(file, std::max(lines, std::size_t{1}), fmt::format("ends here with {}; {}", what, way_out));
  };
  for (const auto& [number, trial] : steps_) {
    if (trial.steps < trial.least)
      fail(fmt::format("{} of the {} steps of trial {}", trial.steps, trial.least, number));
  }
  if (steps_counted_ && *steps_counted_ != lines)
    fail(fmt::format("{} steps, where summary.json counts {}", lines, *steps_counted_));
}

}  // namespace

StageTimes stage_times(const Json& step, const char* key) {
  const Json& ms = step.at(key);
  return {ms.at("local_map"), ms.at("match"),          ms.at("cluster"),
          ms.at("rate"),      ms.value("verify", 0.0), ms.value("after", 0.0)};
}

bool is_results_folder(const fs::path& folder) {
  std::error_code unreachable;
  return fs::exists(folder / mark_of_results, unreachable);
}

std::optional<bool> is_complete(const fs::path& folder) {
  const Json summary = Json::parse(content_of(folder / "summary.json"), nullptr, false);
  const auto complete = summary.is_object() ? summary.find("complete") : summary.end();
  if (complete == summary.end() || !complete->is_boolean()) return std::nullopt;
  return complete->get<bool>();
}

std::map<std::string, Setting> settings_of(const std::string& yaml, const fs::path& file,
                                           const std::map<std::string, std::string>& hashes) {
  std::vector<Fault> faults;
  const auto tree = parse_yaml(yaml, origin_of(file), faults);
  if (!faults.empty()) throw ConfigError(std::move(faults));
  std::map<std::string, Setting> settings;
  flatten(*tree, "", hashes, settings);
  return settings;
}

std::map<std::string, Setting> read_settings(const fs::path& folder,
                                             const std::map<std::string, std::string>& hashes) {
  const fs::path file = folder / "effective.yaml";
  check_readable(file);
  const std::string text = read_text_file(file);
  const auto check = [&](bool is_whole) {
    if (!is_whole)
      refuse(file, line_at(text, text.size()),
             fmt::format("is cut off: it does not end with the key output as glocal run leaves it; {}",
                         way_out));
  };
  check(text.ends_with('\n'));
  std::map<std::string, Setting> settings = settings_of(text, file, hashes);
  // Half a file may be good YAML, too; these are its last keys.
  check(settings.contains("output.steps") && settings.contains("output.maps"));
  return settings;
}

StoredRun read_results(const fs::path& folder, const LineReaders& also, ResultParts parts) {
  return ResultsReader(folder, also).read(parts);
}

void require_steps(const StoredRun& run) {
  if (!run.has_steps)
    refuse(run.folder / "steps.jsonl", 0,
           "is not there; run the experiment again with --set output.steps=true");
}

std::vector<fs::path> results_folders(const fs::path& path) {
  std::error_code unreachable;
  if (!fs::is_directory(path, unreachable))
    refuse(path, 0, "is no folder; name a folder that glocal run has left");
  // Whoever may not search a folder does not know what is in it.
  static_cast<void>(fs::status(path / ".", unreachable));
  if (unreachable) refuse_to_look(path, unreachable);
  if (holds_results(path)) return {path};
  std::vector<fs::path> folders;
  for (const fs::path& folder : folders_in(path)) {
    const bool is_hidden = folder.filename().string().starts_with('.');
    if (!is_hidden && holds_results(folder)) folders.push_back(folder);
  }
  if (folders.empty()) {
    refuse(path, 0,
           "holds no results: there is no provenance.json, neither here nor in a folder below; name a folder "
           "that glocal run has left");
  }
  sort_by_variant(path, folders);
  return folders;
}

}  // namespace glocal
