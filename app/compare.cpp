// glocal compare: which of several methods on the same starts is better, and whether that can be told.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/comparison/comparison.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/report_blocks.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "evaluation/sweeps/comparison_output.hpp"

namespace glocal::app {
namespace {

struct CompareOptions {
  std::vector<std::string> folders;
  std::string baseline;
  std::vector<std::string> out;  ///< *.json, *.csv or *.md.
  bool full = false;
  bool json = false;
  bool no_times = false;
  bool time_anew = false;
  bool trust_plugins = false;
  bool force = false;
};

/// The comparison as the ending of a file's name asks for it.
std::string written_as(const ComparisonOutput& output, const std::string& file) {
  if (file.ends_with(".csv")) return output.csv;
  return file.ends_with(".md") ? as_markdown(output.full) : json_text(output.json, 2) + "\n";
}

/// What is wrong with a file's name; empty if nothing is.
std::string why_no_output(const std::string& file) {
  const bool is_known = file.ends_with(".json") || file.ends_with(".csv") || file.ends_with(".md");
  return is_known ? "" : file + ": the name says no format; end it with .json, .csv or .md";
}

/// For who writes --json FILE, as it was before; empty for a folder.
std::string why_no_folder(const std::string& folder) {
  return folder.ends_with(".json") ? "--json prints; -o " + folder + " writes this file" : "";
}

/// A stored run with all that it takes to run it again.
struct Rerun {
  Rerun(NamedRun& run, Experiment stored, Context& context)
      : of(run),
        experiment(std::move(stored)),
        loader(context.catalog, warn),
        loaded(loader.load(experiment)),
        localizer(make_localizer(experiment, context.catalog, loaded)) {}

  NamedRun& of;
  Experiment experiment;
  ExperimentLoader loader;
  LoadedExperiment& loaded;
  Localizer localizer;
};

[[noreturn]] void refuse(const Rerun& rerun, std::size_t trial, const std::string& what) {
  throw ConfigError(rerun.of.results.folder,
                    fmt::format("trial {} {}: its program, plugins or inputs were others; run it anew, and "
                                "compare that",
                                trial, what));
}

double median_step_cpu_ms(const TrialRecord& record) {
  std::vector<double> ms;
  for (const StepRecord& step : record.records) ms.push_back(step.result.stage_cpu_ms.total());
  return quantile(std::move(ms), 0.5);
}

/// Runs a trial, and keeps its time where the stored results have it.
void take_time(Rerun& rerun, std::size_t trial) {
  const auto record = run_trial(rerun.localizer, rerun.loaded.drive, *rerun.loaded.map, rerun.experiment,
                                trial, rerun.loaded.starts[trial], {});
  auto& stored = rerun.of.results.trials;
  const auto at =
      stored.find({static_cast<std::int64_t>(record->start_sample), record->start_m, record->start_stamp});
  // An interrupted run has not got to all of them.
  if (at == stored.end() && !rerun.of.results.complete) return;
  if (at == stored.end()) refuse(rerun, trial, "starts at another place than any that is stored");
  TrialResult& result = at->second;
  if (result.outcome != record->outcome || result.steps != static_cast<double>(record->steps))
    refuse(rerun, trial, "ends otherwise than is stored");
  result.step_cpu_ms.reset();
  if (!record->records.empty()) result.step_cpu_ms = median_step_cpu_ms(*record);
}

/// Runs the experiments of stored runs again, trial by trial in turn, and puts the CPU times of their steps
/// in the place of the stored ones: what the machine does besides then falls on all of them. Throws
/// ConfigError where an experiment cannot be run again, or gives other answers than are stored.
void measure_times_anew(std::vector<NamedRun>& runs, bool trust_plugins, Context& context) {
  std::list<Rerun> reruns;  // which do not move
  FaultCollector faults;
  for (NamedRun& run : runs) {
    faults.collect([&] {
      const auto effective = run.results.folder / "effective.yaml";
      reruns.emplace_back(run, read_stored_experiment(effective, trust_plugins, context), context);
    });
  }
  faults.report();
  std::size_t trials = 0;
  for (const Rerun& rerun : reruns) trials = std::max(trials, rerun.loaded.starts.size());
  for (std::size_t trial = 0; trial < trials; ++trial) {
    for (Rerun& rerun : reruns) {
      if (trial < rerun.loaded.starts.size()) take_time(rerun, trial);
    }
    // Who comes first finds other caches: each in turn.
    reruns.splice(reruns.end(), reruns, reruns.begin());
  }
  for (const Rerun& rerun : reruns) {
    rerun.of.results.machine = {};
    rerun.of.results.machine.threads = rerun.experiment.threads;
  }
}

void compare_runs(const CompareOptions& options, Context& context) {
  std::vector<NamedRun> runs = read_runs(options.folders);
  if (runs.size() < 2) {
    throw ConfigError(options.folders.front(),
                      "there is nothing to compare it with; name two folders of results or more");
  }
  const std::size_t baseline = find_baseline(runs, options.baseline);
  AtomicFiles files(options.force);
  // Before anything is run anew for them.
  for (const std::string& file : options.out) files.check(file);
  if (options.time_anew) measure_times_anew(runs, options.trust_plugins, context);
  const ComparisonOutput output =
      comparison_output(runs, baseline, options.no_times ? measures_but_time() : measures());
  for (const std::string& file : options.out) files.add(file, written_as(output, file));
  files.commit();
  if (options.json) {
    answer("{}\n", json_text(output.json, 2));
  } else if (options.full) {
    answer(as_text(output.full));
  } else {
    answer("{}\n  Tests, medians and means: --full.\n", as_text(output.brief));
  }
}

}  // namespace

void add_compare(CLI::App& app, Context& context) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare methods on the same starts, with tests of what differs.");
  command->add_option("DIR", options->folders, "Folders of results, or folders that hold some")
      ->required()
      ->check(why_no_folder);
  command->add_option(
      "--baseline", options->baseline,
      "Method to compare with, by its name, or by its run's folder or experiment (default: the "
      "first)");
  command->add_flag("--full", options->full, "Show all tests, and how to read them");
  command->add_flag("--json", options->json, "Print everything as JSON");
  command
      ->add_option("-o,--out", options->out,
                   "File to write, too: all as *.json, a row for each variant and test as *.csv, all tests "
                   "as *.md (repeatable)")
      ->allow_extra_args(false)
      ->check(why_no_output);
  CLI::Option* no_times =
      command->add_flag("--no-times", options->no_times, "Leave times out, which no two runs have in common");
  CLI::Option* time_anew =
      command
          ->add_flag("--time", options->time_anew,
                     "Run all again on this machine, trial by trial in turn, and compare these times")
          ->excludes(no_times);
  command
      ->add_flag("--trust-plugins", options->trust_plugins,
                 "Load the plugins that the folders name, which are native code")
      ->needs(time_anew);
  command->add_flag("--force", options->force, "Replace files that exist");
  command->callback([options, &context] { compare_runs(*options, context); });
}

}  // namespace glocal::app
