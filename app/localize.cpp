// glocal localize: an answer from a map and a log, without an experiment file.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/drive_options.hpp"
#include "app/experiment_options.hpp"
#include "app/interrupts.hpp"
#include "app/localize_plan.hpp"
#include "app/numbers.hpp"
#include "app/reading_bar.hpp"
#include "app/report_file.hpp"
#include "app/run_report.hpp"
#include "app/standard_streams.hpp"
#include "app/step_text.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/experiment_runner.hpp"

namespace glocal::app {
namespace {

struct LocalizeOptions {
  LocalizeRequest request;
  std::vector<double> region, heading;  ///< As given.
  ExperimentOptions changes;
  std::string out;
  bool force = false;
};

/// "right: 0.01 m and 0.5 deg off the reference", or nothing without a reference.
std::string judged(const TrialRecord& trial) {
  if (!trial.error) return "";
  return fmt::format(" ({}: {:.3f} m and {:.2f} deg off the reference)", to_string(trial.outcome),
                     trial.error->translation_m, degrees(trial.error->rotation_rad));
}

/// What was found wrong last with the robot's set-up, perhaps after the declaration; nothing if all is well.
std::string fault_of_setup(const TrialRecord& trial) {
  for (auto step = trial.records.rbegin(); step != trial.records.rend(); ++step) {
    if (step->result.setup && step->result.setup->fault) return step->result.setup->why();
  }
  return "";
}

/// Tells what is found while it is found.
class Narrator {
 public:
  RunnerCallbacks callbacks() {
    RunnerCallbacks callbacks;
    callbacks.begin = [this](const LoadedVariant& variant) { begin(variant); };
    callbacks.trials = {[this](std::size_t, const StepRecord& record, const Localizer&) { step(record); },
                        [this](const TrialRecord& trial) { finish(trial); }, is_interrupted};
    callbacks.note = [](const std::string& text) { spdlog::info(text); };
    callbacks.warn = warn;
    callbacks.progress = bar_.call();
    return callbacks;
  }

 private:
  void begin(const LoadedVariant& variant) {
    const LoadedExperiment& loaded = variant.loaded;
    map_ = loaded.map.get();
    drive_ = &loaded.drive;
    motion_ = variant.experiment.localizer.motion;
    tells_steps_ = loaded.starts.size() == 1;
    first_sample_ = loaded.starts.front();
    answer("map         {} points\n", loaded.map->points().size());
    answer("drive       {} observations over {:.1f} m, {} {}\n\n", drive_->samples.size(),
           drive_->path_m.back(), loaded.starts.size(), tells_steps_ ? "start" : "starts");
  }

  void step(const StepRecord& record) {
    if (!tells_steps_) return;
    const StepResult& result = record.result;
    const double way = drive_->path_m[first_sample_ + result.step] - drive_->path_m[first_sample_];
    answer("{}\n", text_of(result, *map_, way));
    if (result.verdict.why != last_why_) answer("          {}\n", result.verdict.why);
    last_why_ = result.verdict.why;
  }

  void finish(const TrialRecord& trial) const {
    const std::string from = tells_steps_ ? "" : fmt::format("from {:.1f} m: ", trial.start_m);
    if (trial.outcome == Outcome::failed) {
      spdlog::error("{}{}", from, trial.why);
    } else if (trial.pose) {
      answer("{}localized after {} {}, {:.2f} m: {}{}\n", from, trial.steps,
             trial.steps == 1 ? "step" : "steps", trial.distance_m,
             text_of(map_->place_of(*trial.pose), motion_), judged(trial));
    } else {
      const auto guess = trial.records.empty() ? std::nullopt : trial.records.back().result.estimate();
      answer("{}not localized in {} steps, {:.2f} m: {}{}\n", from, trial.steps, trial.distance_m, trial.why,
             guess ? "; the best guess is " + text_of(map_->place_of(*guess), motion_) : "");
    }
    const std::string fault = fault_of_setup(trial);
    if (!fault.empty()) spdlog::warn("{}{}", from, fault);
  }

  ReadingBar bar_;
  const GlobalMap* map_ = nullptr;
  const Drive* drive_ = nullptr;
  Motion motion_ = Motion::planar;
  bool tells_steps_ = true;
  std::size_t first_sample_ = 0;
  std::string last_why_;
};

/// Of several starts.
void print_figures(const RunResult& result) {
  const auto summary = nlohmann::ordered_json::parse(content_of(result.variants.front().summary));
  if (summary["trials"]["count"].get<int>() < 2) return;
  answer("\n");
  print_summary(summary, result.folder);
}

/// The same experiment again is no reason to stop: a run that was interrupted is gone on with. What is in
/// the way of the experiment or the page is told before either is written.
void write_experiment(const std::string& file, const std::string& content, bool replace,
                      const ReportOptions& report) {
  AtomicFiles files(replace);
  if (content_of(file) != content) files.add(file, content);
  AtomicFiles(report.files.replace).check(report.out);
  files.commit();
}

/// What is wrong with it, the experiment's reader says.
Prior prior_of(const LocalizeOptions& options) {
  Prior prior;
  if (!options.region.empty()) prior.region = {options.region[0], options.region[1], options.region[2]};
  if (!options.heading.empty()) prior.heading = {options.heading[0], options.heading[1]};
  return prior;
}

void localize(const LocalizeOptions& options, Context& context) {
  LocalizeRequest request = options.request;
  request.prior = prior_of(options);
  request.plugins = context.plugins.loaded();
  ReadingBar bar;
  request.progress = bar.call();
  const LocalizePlan plan = plan_localization(request, context.catalog);
  const std::string out = options.out.empty() ? "results/" + plan.name : options.out;
  const std::string file = out + ".yaml";
  // The page of a run that was interrupted is its own, and this one goes on with that.
  const bool goes_on = is_complete(out) == false;
  ReportOptions report{.out = out + ".html", .files = {.replace = options.force || goes_on}};
  write_experiment(file, plan.experiment + options.changes.comment(), options.force, report);
  for (const std::string& choice : plan.choices) answer("{}\n", choice);
  answer("experiment  {}\n", file);
  std::fflush(stdout);

  listen_to_interrupts();
  Narrator narrator;
  RunOptions run{.out = out, .force = options.force, .command = context.command_line};
  run.plugins = context.plugins.loaded();
  const RunResult result = ExperimentRunner(options.changes.read_variants(file, context), file,
                                            context.catalog, std::move(run), narrator.callbacks())
                               .run();
  print_figures(result);
  context.exit_code = exit_code_of(result);
  report.folders = {result.folder.string()};
  answer("report      {}\n", write_report(report).string());
}

}  // namespace

void add_localize(CLI::App& app, Context& context) {
  auto options = std::make_shared<LocalizeOptions>();
  LocalizeRequest& request = options->request;
  CLI::App* command = app.add_subcommand(
      "localize",
      "Find a robot on a map from what it has recorded; no experiment file is needed, one is written.");
  command
      ->add_option("MAP", request.map, "Map server's YAML, cloud (PCD, PLY), octree, or recording with a map")
      ->required();
  command
      ->add_option("--also", request.more_maps,
                   "Another map, as of another floor; the robot is on any of them (may be repeated)")
      ->allow_extra_args(false);
  command->add_option("LOG", request.log, "ROS bag, MCAP, CARMEN log, or folder of clouds with odometry.tum")
      ->required();
  CLI::Option* start =
      command->add_option("--start", request.start_m, "Begin so far along the drive, m")->check(from_zero());
  CLI::Option* every =
      command->add_option("--every", request.every_m, "Begin anew every so many metres, knowing nothing")
          ->check(above_zero());
  command->add_flag("--whole", request.whole, "Go on to the end of the drive")
      ->excludes(start)
      ->excludes(every);
  start->excludes(every);
  command->add_option("--scans", request.scans, "Topics with scans (default: those of the widest view)");
  command->add_option(
      "--odometry", request.odometry,
      "Topic with odometry, or for a folder of clouds the file (default: tf, or the only one)");
  command->add_option("--odom-frame", request.odom_frame,
                      "Frame of tf that odometry counts from (default: odom)");
  command->add_option("--base-frame", request.base_frame,
                      "Frame of the robot (default: base_footprint or base_link)");
  command->add_option(
      "--reference", request.reference,
      "Reference poses, only to judge the answer: topic or frame of tf, or for clouds a file");
  command->add_option("--region", options->region, "Look only at starts so near to a place on the map, m")
      ->type_name("X Y RADIUS")
      ->expected(3);
  command
      ->add_option("--heading", options->heading,
                   "Look only at starts with headings half the width or less from this one, deg")
      ->type_name("DEG WIDTH")
      ->expected(2);
  command->add_option(
      "--method", request.method,
      "Localizer: a name (glocal list methods) or a file (default: indexed, and for maps in space "
      "lidar_upright)");
  add_strict(*command, request.strict);
  options->changes.add_overrides_to(*command);
  command->add_option("-o,--out", options->out, "Folder for the results (default: results/localize_LOG)");
  command->add_flag("--force", options->force, "Replace earlier results");
  command->callback([options, &context] { localize(*options, context); });
}

}  // namespace glocal::app
