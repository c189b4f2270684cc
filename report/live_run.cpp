#include "report/live_run.hpp"

#include <algorithm>
#include <utility>

#include "evaluation/results/map_files.hpp"
#include "evaluation/results/writers.hpp"
#include "evaluation/running/trials.hpp"
#include "report/map_points.hpp"
#include "report/point_lives.hpp"
#include "report/report_data.hpp"
#include "report/scan_frames.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

/// Of finished trials, so that neither memory nor answers grow with a long run.
constexpr std::size_t most_steps = 10'000;

/// Whoever asked this long ago, or longer, does not watch any more.
constexpr std::chrono::seconds patience{5};

/// One frame, of this step.
Json of_step(Json frames, std::size_t step) {
  frames["steps"] = Json::array({step});
  return frames;
}

Json latest_local_map(const Points& points, std::size_t step) {
  PointLives lives(points.size());
  lives.add(points);
  return of_step(to_json(lives), step);
}

Json latest_scan(const Points& hits, std::size_t step) {
  ScanFrames frames(hits.size());
  frames.add(hits);
  return of_step(frames.to_json(), step);
}

}  // namespace

void LiveRun::begin(const std::string& variant, const std::filesystem::path& folder,
                    const std::map<std::string, Setting>& settings, const LoadedExperiment& loaded) {
  const GlobalMap& global = *loaded.map;
  Json shown = map_points(global.points(), global.origin());
  if (!global.grid().cells.empty()) shown["grid"] = grid_json(global.grid(), global.origin());
  auto map = std::make_shared<const Json>(std::move(shown));
  Json values = to_json(settings);
  const std::lock_guard lock(mutex_);
  variant_ = variant;
  folder_ = folder.string();
  settings_ = std::move(values);
  map_ = std::move(map);
  loaded_ = &loaded;
  running_.clear();
  finished_.clear();
  ++version_;
}

void LiveRun::step(std::size_t trial, const StepRecord& record, const Points& local_map,
                   const RunProgress& progress) {
  const Json line = step_json(trial, record, clusters);
  const std::size_t sample = loaded_->starts[trial] + record.result.step;
  Points latest = local_map;
  Points hits = loaded_->drive.samples[sample].observation.scan.hits;
  const std::lock_guard lock(mutex_);
  const auto [running, is_first] = running_.try_emplace(trial);
  if (is_first)
    running->second.start =
        start_json(begun_trial(loaded_->drive, record.result.motion, trial, loaded_->starts[trial]));
  running->second.columns.add(line);
  running->second.step = record.result.step;
  running->second.local_map = std::move(latest);
  running->second.hits = std::move(hits);
  progress_ = progress;
  ++version_;
}

void LiveRun::finish(const TrialRecord& trial, const RunProgress& progress) {
  auto line = std::make_shared<const Json>(Json::parse(trial_line(trial)));
  const std::lock_guard lock(mutex_);
  const RunningTrial& running = running_[trial.trial];
  finished_[trial.trial] = {running.columns.size(), std::move(line),
                            std::make_shared<const Json>(running.columns.to_json())};
  running_.erase(trial.trial);
  forget_old_steps();
  progress_ = progress;
  ++version_;
}

void LiveRun::forget_old_steps() {
  std::size_t steps = 0;
  for (const auto& [number, trial] : finished_) steps += trial.columns ? trial.steps : 0;
  for (auto trial = finished_.begin(); trial != finished_.end() && steps > most_steps; ++trial) {
    if (!trial->second.columns) continue;
    trial->second.columns.reset();
    steps -= trial->second.steps;
  }
}

void LiveRun::end() {
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  ++version_;
}

std::optional<LiveRun::News> LiveRun::news(std::optional<std::uint64_t> known) {
  Json data = report_head();
  std::unique_lock lock(mutex_);
  if (known == version_) return std::nullopt;
  const std::uint64_t version = version_;
  data["live"] = {{"experiment", experiment_},
                  {"variant", variant_},
                  {"trials_done", progress_.finished},
                  {"trials", progress_.trials}};
  if (progress_.remaining_s) data["live"]["remaining_s"] = *progress_.remaining_s;
  data["live"]["finished"] = is_over_;
  data["live"]["version"] = version_;
  Json run = {
      {"name", variant_.empty() ? experiment_ : variant_}, {"folder", folder_}, {"settings", settings_}};
  const auto map = map_;
  const auto running = running_;
  const auto finished = finished_;
  lock.unlock();

  // All that takes long is done on copies, while the run goes on.
  data["maps"] = Json::array();
  if (map) {
    data["maps"].push_back(*map);
    run["map"] = 0;
  }
  std::map<std::size_t, Json> trials;
  for (const auto& [number, trial] : finished) {
    trials[number] = *trial.line;
    if (trial.columns) trials[number]["columns"] = *trial.columns;
  }
  for (const auto& [number, trial] : running) {
    trials[number] = {{"trial", number},
                      {"start", trial.start},
                      {"columns", trial.columns.to_json()},
                      {"local_map", latest_local_map(trial.local_map, trial.step)},
                      {"scans", latest_scan(trial.hits, trial.step)}};
  }
  run["trials"] = Json::array();
  for (auto& [number, trial] : trials) run["trials"].push_back(std::move(trial));
  data["runs"] = Json::array({std::move(run)});
  return News{version, std::move(data)};
}

void LiveRun::told(std::uint64_t version) {
  const std::lock_guard lock(mutex_);
  told_version_ = std::max(told_version_, version);
  told_at_ = Clock::now();
  was_told_.notify_all();
}

void LiveRun::wait_until_told(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  if (!told_at_ || Clock::now() - *told_at_ > patience) return;
  was_told_.wait_for(lock, longest, [&] { return told_version_ == version_; });
}

}  // namespace glocal
