#include "app/compare_times.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <list>
#include <string>

#include "app/experiment_options.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/statistics/statistics.hpp"

namespace glocal::app {
namespace {

/// A stored run with all that it takes to run it again.
struct Rerun {
  Rerun(NamedRun& run, Experiment stored, Context& context)
      : of(run),
        experiment(std::move(stored)),
        loader(context.catalog, [](const std::string& text) { spdlog::warn(text); }),
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
  const auto record =
      run_trial(rerun.localizer, rerun.loaded.drive, *rerun.loaded.map, rerun.experiment, trial,
                rerun.loaded.starts[trial], {[](const auto&, const auto&) {}, [] { return false; }});
  auto& stored = rerun.of.results.trials;
  const auto at =
      stored.find({static_cast<std::int64_t>(record->start_sample), record->start_m, record->start_stamp});
  if (at == stored.end()) refuse(rerun, trial, "starts at another place than any that is stored");
  TrialResult& result = at->second;
  if (result.outcome != record->outcome || result.steps != static_cast<double>(record->steps))
    refuse(rerun, trial, "ends otherwise than is stored");
  result.step_cpu_ms.reset();
  if (!record->records.empty()) result.step_cpu_ms = median_step_cpu_ms(*record);
}

}  // namespace

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
  for (NamedRun& run : runs) {
    const int threads = run.results.machine.threads;
    run.results.machine = {};
    run.results.machine.threads = threads;
  }
}

}  // namespace glocal::app
