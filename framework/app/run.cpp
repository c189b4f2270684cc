// glocal run: runs an experiment and leaves its results in a folder.
#include "pipeline/run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "experiment_options.hpp"
#include "glocal/experiment.hpp"
#include "results/output_folder.hpp"
#include "results/provenance.hpp"
#include "results/summary.hpp"
#include "results/writers.hpp"

namespace glocal::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;

struct RunOptions {
  ExperimentOptions experiment;
  std::string out;
  bool force = false;
  bool quiet = false;
};

/// One line on a terminal that is written over again and again.
class ProgressBar {
 public:
  ProgressBar(bool shown, std::size_t trials)
      : shown_(shown && isatty(STDERR_FILENO) == 1), trials_(trials) {}
  ~ProgressBar() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `share` of the current trial's samples are done.
  void show(std::size_t trial, std::size_t step, double share, const char* verdict) {
    using Clock = std::chrono::steady_clock;
    if (!shown_ || Clock::now() - last_ < std::chrono::milliseconds(100)) return;
    last_ = Clock::now();
    constexpr int width = 30;
    const double done = (static_cast<double>(trial) + share) / static_cast<double>(trials_);
    const auto filled = static_cast<int>(done * width);
    fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] trial {}/{}  step {}  {}", "", filled, "", width - filled,
               trial + 1, trials_, step + 1, verdict);
    std::fflush(stderr);
  }

 private:
  bool shown_;
  std::size_t trials_;
  std::chrono::steady_clock::time_point last_;
};

/// Writes what a trial leaves behind, once it is finished.
class ResultsWriter {
 public:
  ResultsWriter(OutputFolder& folder, const OutputConfig& config) : folder_(folder), config_(config) {
    folder_.append("trials.jsonl", "");
    if (config_.steps) folder_.append("steps.jsonl", "");
  }

  void step(const StepRecord& record, const Localizer& localizer) {
    if (!keeps_map(trial_)) return;
    local_maps_.push_back({record.result.step, {"pcd", pcd(localizer.local_map().points)}});
    for (MapFile& file : localizer.local_map_files())
      local_maps_.push_back({record.result.step, std::move(file)});
  }

  void finish(const TrialRecord& trial) {
    folder_.append("trials.jsonl", trial_line(trial));
    if (config_.steps) {
      std::string lines;
      for (const StepRecord& record : trial.records) lines += step_line(trial.trial, record);
      folder_.append("steps.jsonl", lines);
    }
    const Trajectories trajectories = tum_trajectories(trial);
    folder_.append(fmt::format("trajectories/trial_{:04}_estimate.tum", trial.trial), trajectories.estimate);
    if (!trajectories.reference.empty()) {
      folder_.append(fmt::format("trajectories/trial_{:04}_reference.tum", trial.trial),
                     trajectories.reference);
    }
    for (const auto& [step, file] : local_maps_) {
      folder_.append(fmt::format("maps/trial_{:04}/step_{:04}.{}", trial.trial, step, file.extension),
                     file.content);
    }
    local_maps_.clear();
    ++trial_;
  }

 private:
  [[nodiscard]] bool keeps_map(std::size_t trial) const {
    return config_.maps == "all" || (config_.maps == "first_trial" && trial == 0);
  }

  OutputFolder& folder_;
  const OutputConfig& config_;
  std::size_t trial_ = 0;
  std::vector<std::pair<std::size_t, MapFile>> local_maps_;
};

void print_summary(const nlohmann::ordered_json& s, const std::filesystem::path& folder) {
  const auto& trials = s["trials"];
  fmt::print("{}, seed {}{}\n", s["name"].get<std::string>(), s["seed"].get<std::uint64_t>(),
             s["complete"].get<bool>() ? "" : " (interrupted: some trials are missing)");
  fmt::print("  trials              {}: {} right, {} wrong, {} undecided\n", trials["count"].get<int>(),
             trials["right"].get<int>(), trials["wrong"].get<int>(), trials["undecided"].get<int>());
  if (trials.contains("failed")) fmt::print("  failed              {}\n", trials["failed"].get<int>());
  const auto& rate = s["success_rate"];
  fmt::print("  success             {:.1f} % (95 %: {:.1f} to {:.1f} %)\n",
             100.0 * rate["value"].get<double>(), 100.0 * rate["low"].get<double>(),
             100.0 * rate["high"].get<double>());
  if (trials["right"].get<int>() > 0) {
    fmt::print("  localized after     {:.0f} steps, {:.1f} m (median)\n",
               s["steps_to_localize"]["median"].get<double>(),
               s["distance_to_localize_m"]["median"].get<double>());
    fmt::print("  error then          {:.3f} m, {:.2f} deg (median); {:.3f} m, {:.2f} deg (largest)\n",
               s["translation_error_m"]["median"].get<double>(),
               s["rotation_error_deg"]["median"].get<double>(), s["translation_error_m"]["max"].get<double>(),
               s["rotation_error_deg"]["max"].get<double>());
  }
  const auto& later = s["after_declaration"];
  if (later["steps"].get<std::size_t>() > trials["count"].get<std::size_t>()) {
    fmt::print("  error from then on  {:.3f} m, {:.2f} deg (largest of {} steps on the map)\n",
               later["translation_error_m"]["max"].get<double>(),
               later["rotation_error_deg"]["max"].get<double>(), later["steps"].get<std::size_t>());
  }
  fmt::print("  time for a step     {:.1f} ms (median), {:.1f} ms (95 %); matching {:.1f} ms (median)\n",
             s["step_ms"]["median"].get<double>(), s["step_ms"]["p95"].get<double>(),
             s["stage_ms"]["match"]["median"].get<double>());
  fmt::print("  time for the map    {:.0f} ms to load, {:.0f} ms to index\n",
             s["map"]["build_ms"].get<double>(), s["map"]["index_ms"].get<double>());
  fmt::print("  results             {}\n", folder.string());
}

void run(const RunOptions& options, Context& context) {
  Experiment experiment = options.experiment.read(context);
  const std::filesystem::path out = options.out.empty() ? std::filesystem::path("results") / experiment.name
                                                        : std::filesystem::path(options.out);
  // From here on an interrupt ends the run in good order.
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });
  Prepared prepared =
      prepare(experiment, context.catalog, [](const std::string& text) { spdlog::warn(text); });
  prepared.inputs.insert(std::filesystem::absolute(options.experiment.file));
  prepared.inputs.insert(context.plugins.loaded().begin(), context.plugins.loaded().end());
  const auto start = std::chrono::steady_clock::now();
  Localizer localizer = make_localizer(experiment, context.catalog, prepared);
  const double map_index_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();

  // Nothing is written before everything is known to be in order.
  OutputFolder folder(out, options.force);
  folder.append("effective.yaml", effective_yaml(experiment, context.catalog));
  folder.append("provenance.json",
                provenance(context.catalog, experiment.threads, prepared.inputs).dump(2) + "\n");
  if (experiment.output.maps != "none") folder.append("maps/global.pcd", pcd(prepared.map->points()));

  ProgressBar progress(!options.quiet, prepared.starts.size());
  ResultsWriter writer(folder, experiment.output);
  Summary summary;
  std::size_t trial = 0;
  const auto stop = [] { return interrupted != 0; };
  const auto on_step = [&](const StepRecord& record, const Localizer& now) {
    writer.step(record, now);
    const auto& result = record.result;
    const std::size_t steps = std::min(prepared.drive.samples.size(), step_limit(experiment.trials));
    progress.show(trial, result.step, static_cast<double>(result.step) / static_cast<double>(steps),
                  to_string(result.verdict.kind));
  };
  const bool complete =
      run_trials(localizer, experiment, prepared, {on_step, stop}, [&](const TrialRecord& record) {
        writer.finish(record);
        if (record.outcome == Outcome::failed) {
          spdlog::error("trial {} failed in step {}: {}", record.trial, record.records.size(), record.why);
          context.exit_code = 1;
        }
        summary.add(record);
        ++trial;
      });

  const auto json =
      summary.to_json({experiment.name, experiment.seed, complete, prepared.map->points().size(),
                       prepared.map_build_ms, map_index_ms, localizer.map_index()});
  folder.append("summary.json", json.dump(2) + "\n");
  folder.commit();
  if (!options.quiet) print_summary(json, folder.path());
  if (!complete) {
    spdlog::warn("interrupted: {} of {} trials were finished and kept", trial, prepared.starts.size());
    context.exit_code = 3;
  }
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run an experiment and leave its results in a folder.");
  options->experiment.add_to(*command);
  command->add_option("--out", options->out, "Folder for the results (default: results/NAME)");
  command->add_flag("--force", options->force, "Replace earlier results in that folder");
  command->add_flag("--quiet", options->quiet, "No progress bar and no summary");
  command->callback([options, &context] { run(*options, context); });
}

}  // namespace glocal::app
