#include "pipeline/run.hpp"

#include <chrono>
#include <optional>

namespace glocal {

Prepared prepare(const Experiment& experiment, const Catalog& catalog, const Warn& warn) {
  Prepared prepared;
  const SourceSetup setup{
      .seed = experiment.seed, .warn = warn, .note_input = [&](const std::filesystem::path& file) {
        prepared.inputs.insert(file);
      }};
  const auto start = std::chrono::steady_clock::now();
  prepared.map = std::make_shared<const GlobalMap>(catalog.map_sources.make(experiment.map, setup)->load());
  prepared.map_build_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  prepared.drive = read_drive(*catalog.observation_sources.make(experiment.observations, setup));
  prepared.starts = trial_starts(experiment.trials, prepared.drive, *prepared.map);
  return prepared;
}

Localizer make_localizer(const Experiment& experiment, const Catalog& catalog, Prepared& prepared) {
  const StageSetup setup{
      .map = prepared.map,
      .threads = experiment.threads,
      .note_input = [&](const std::filesystem::path& file) { prepared.inputs.insert(file); }};
  return {experiment.localizer, catalog, setup, experiment.seed};
}

bool run_trials(Localizer& localizer, const Experiment& experiment, const Prepared& prepared,
                const TrialCallbacks& callbacks, const std::function<void(const TrialRecord&)>& done) {
  for (std::size_t trial = 0; trial < prepared.starts.size(); ++trial) {
    const auto record = run_trial(localizer, prepared.drive, *prepared.map, experiment, trial,
                                  prepared.starts[trial], callbacks);
    if (!record) return false;
    done(*record);
  }
  return true;
}

}  // namespace glocal
