#include "glocal/run_experiment.hpp"

#include <utility>

#include "evaluation/running/experiment_runner.hpp"

namespace glocal {

RunResult run_variants(std::vector<Variant> variants, const std::filesystem::path& file,
                       const Catalog& catalog, const RunOptions& options, const RunObserver& observer) {
  RunnerCallbacks callbacks;
  callbacks.begin = [&](const LoadedVariant& variant) {
    observer.begin({variant.name, variant.folder, variant.loaded.starts.size(), variant.finished});
  };
  callbacks.trials = {
      [&](std::size_t trial, const StepRecord& step, const Localizer&) { observer.step(trial, step.result); },
      [&](const TrialRecord& trial) {
        observer.trial({trial.trial, trial.outcome, trial.steps, trial.distance_m, trial.pose, trial.why});
      },
      observer.stop};
  callbacks.note = observer.note;
  callbacks.warn = observer.warn;
  return ExperimentRunner(std::move(variants), file, catalog, options, std::move(callbacks)).run();
}

RunResult run_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides,
                         const Catalog& catalog, const RunOptions& options, const RunObserver& observer) {
  return run_variants(read_variants(file, overrides, catalog), file, catalog, options, observer);
}

}  // namespace glocal
