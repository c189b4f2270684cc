#include "report/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "evaluation/comparison/comparison_writers.hpp"
#include "evaluation/comparison/methods.hpp"
#include "evaluation/results/map_changes.hpp"
#include "evaluation/results/map_files.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/sweeps/analysis.hpp"
#include "evaluation/sweeps/sweep_report.hpp"
#include "report/map_points.hpp"
#include "report/numbers.hpp"
#include "report/packed.hpp"
#include "version.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int format = 1;

/// How many recordings of a kind there are: step_0000.pcd, step_0001.pcd …
std::size_t count_recordings(const fs::path& folder, std::string_view kind) {
  std::size_t n = 0;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    n += name.starts_with(kind) && name.ends_with(".pcd") ? 1 : 0;
  }
  return n;
}

/// Distributions are drawn from so many values of a run.
constexpr std::size_t most_times = 200;
constexpr const char* stamp_key = "stamp";

/// All of them in their order, or as many as are drawn, equally far apart in it, with both ends.
Json drawn_times(std::vector<float> ms) {
  std::sort(ms.begin(), ms.end());
  const std::size_t drawn = std::min(ms.size(), most_times);
  Json json = Json::array();
  for (std::size_t i = 0; i < drawn; ++i) {
    const std::size_t rank = drawn < 2 ? 0 : i * (ms.size() - 1) / (drawn - 1);
    json.push_back(short_number(double{ms[rank]}, 4));
  }
  return json;
}

}  // namespace

Json to_json(const std::map<std::string, Setting>& settings) {
  Json json = Json::object();
  for (const auto& [path, setting] : settings) {
    json[path]["text"] = setting.text;
    if (setting.identity != setting.text) json[path]["identity"] = setting.identity;
  }
  return json;
}

Json report_head() {
  return {{"format", format}, {"generator", fmt::format("glocal {} ({})", version, revision())}};
}

StoredRun ReportData::add(const fs::path& folder) {
  FaultCollector faults;
  Run run;
  run.folder = folder;
  StoredRun stored = read_files(run, faults);
  read_map(run, faults);
  for (const auto& [number, trial] : run.trials) read_recordings(run, number, faults);
  faults.report();
  runs_.push_back(std::move(run));
  share_limits();
  return stored;
}

/// Everything but point clouds.
StoredRun ReportData::read_files(Run& run, FaultCollector& faults) const {
  StoredRun stored;
  const LineReaders lines = {[&](const Json& line) { run.trials[line.at("trial")].line = line; },
                             [&](const Json& line) {
                               std::optional<StepColumns>& steps = run.trials.at(line.at("trial")).steps;
                               if (!steps) steps.emplace(limits_.clusters);
                               steps->add(line);
                             }};
  const bool is_read = faults.collect([&] { stored = read_results(run.folder, lines); });
  for (auto& [number, trial] : run.trials) {
    // How many steps there are is not known where some cannot be read; and a trial may have failed in its
    // first.
    if (!is_read) trial.steps.reset();
    if (is_read && stored.has_steps && !trial.steps) trial.steps.emplace(limits_.clusters);
  }
  run.summary = stored.summary;
  run.provenance = stored.provenance;
  run.settings = stored.settings;
  return stored;
}

void ReportData::read_map(Run& run, FaultCollector& faults) {
  const fs::path points = run.folder / map_points_file;
  const fs::path grid = run.folder / map_grid_file;
  std::error_code unreachable;
  if (!fs::exists(points, unreachable)) return;
  faults.collect([&] {
    const MapPoints global = read_map_pcd(points);
    Json map = map_points(global.points, global.origin);
    if (fs::exists(grid, unreachable)) map["grid"] = read_grid(grid);
    const auto same = std::find(maps_.begin(), maps_.end(), map);
    run.map = static_cast<std::size_t>(same - maps_.begin());
    if (same == maps_.end()) maps_.push_back(std::move(map));
  });
}

/// Local maps and scans of a trial, and what it has seen of changes.
void ReportData::read_recordings(Run& run, std::size_t number, FaultCollector& faults) {
  Trial& trial = run.trials.at(number);
  const fs::path folder = run.folder / "maps" / fmt::format("trial_{:04}", number);
  const auto read = [&](const char* kind, auto& frames, std::size_t most, std::size_t& trials_with) {
    const std::size_t found = count_recordings(folder, fmt::format("{}_", kind));
    if (found == 0) return;
    frames.emplace(most / ++trials_with);
    const std::size_t steps = trial.steps ? trial.steps->size() : found;
    if (found > steps)
      faults.add({folder.string(), 0, 0,
                  fmt::format("steps.jsonl has {} steps of this trial, where there are {} files {}_NNNN.pcd; "
                              "run the experiment again",
                              steps, found, kind)});
    for (std::size_t step = 0; step < steps; ++step) {
      faults.collect([&] { frames->add(read_pcd(folder / fmt::format("{}_{:04}.pcd", kind, step))); });
    }
  };
  read("step", trial.local_map, limits_.lives, trials_with_maps_);
  read("scan", trial.scans, limits_.scan_points, trials_with_scans_);
  std::error_code unreachable;
  const fs::path changes = run.folder / changes_file(number);
  if (fs::exists(changes, unreachable)) faults.collect([&] { trial.changes = read_changes(changes); });
}

void ReportData::share_limits() {
  for (Run& run : runs_) {
    for (auto& [number, trial] : run.trials) {
      if (trial.local_map) trial.local_map->keep_at_most(limits_.lives / trials_with_maps_);
      if (trial.scans) trial.scans->keep_at_most(limits_.scan_points / trials_with_scans_);
    }
  }
}

void ReportData::add_run(PageData& page, const Run& run, const NamedRun& named) {
  // Where its files were read may have been a place for the moment only.
  Json json = {{"name", named.name},
               {"folder", named.results.folder.string()},
               {"summary", run.summary},
               {"provenance", run.provenance},
               {"settings", glocal::to_json(run.settings)}};
  if (run.map) json["map"] = *run.map;
  json["trials"] = Json::array();
  std::vector<float> step_ms;
  for (const auto& [number, trial] : run.trials) {
    Json entry = with_short_numbers(trial.line, stamp_key);
    if (const Json chunk = chunk_of(trial); !chunk.empty()) {
      entry["chunk"] = page.chunks.size();
      page.chunks.push_back(packed(chunk));
    }
    if (trial.steps)
      step_ms.insert(step_ms.end(), trial.steps->step_ms().begin(), trial.steps->step_ms().end());
    json["trials"].push_back(std::move(entry));
  }
  json["timed_steps"] = step_ms.size();
  json["step_ms"] = drawn_times(std::move(step_ms));
  page.head["runs"].push_back(std::move(json));
}

Json ReportData::chunk_of(const Trial& trial) {
  Json json;
  if (trial.steps) json["columns"] = trial.steps->to_json();
  if (trial.local_map) json["local_map"] = glocal::to_json(*trial.local_map);
  if (!trial.changes.is_null()) json["changes"] = trial.changes;
  if (trial.scans) json["scans"] = trial.scans->to_json();
  return json;
}

PageData ReportData::page_data(const std::vector<NamedRun>& runs, std::size_t baseline) const {
  PageData page{report_head()};
  Json& head = page.head;
  head["maps"] = maps_;
  head["runs"] = Json::array();
  for (std::size_t i = 0; i < runs_.size(); ++i) add_run(page, runs_[i], runs[i]);
  if (runs_.size() < 2) return page;
  if (is_sweep(runs)) {
    const std::string setting = baseline > 0 ? sweep_of(runs)[baseline].part.setting : "";
    head["sweep"] = glocal::to_json(analyse_sweep(runs, {}, setting));
  }
  try {
    // Cases and seeds of one method alone have nothing to be compared with.
    if (methods_of(runs).size() > 1) head["comparison"] = glocal::to_json(compare(runs, baseline));
  } catch (const ConfigError& error) {
    const Fault& fault = error.faults().front();
    head["comparison_refused"] = fmt::format("{}: {}", fault.file, fault.message);
  }
  return page;
}

}  // namespace glocal
