#include "evaluation/running/experiment_loader.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>

#include "glocal/error.hpp"

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

Prepared& Preparer::prepare(Experiment& experiment) {
  Experiment sources = default_experiment();
  sources.seed = experiment.seed;
  sources.map = experiment.map;
  sources.observations = experiment.observations;
  sources.trials = experiment.trials;
  std::string wanted = effective_yaml(sources, catalog_);
  if (wanted != sources_) {
    sources_.clear();
    prepared_ = glocal::prepare(experiment, catalog_, warn_);
    sources_ = std::move(wanted);
    source_inputs_ = prepared_.inputs;
  } else {
    const GlobalMap& map = *prepared_.map;
    prepared_.map =
        std::make_shared<const GlobalMap>(MapData{map.points(), map.normals(), map.grid(), map.path()});
    prepared_.inputs = source_inputs_;
  }
  return prepared_;
}

Localizer make_localizer(const Experiment& experiment, const Catalog& catalog, Prepared& prepared) {
  const StageSetup setup{
      .map = prepared.map,
      .threads = experiment.threads,
      .note_input = [&](const std::filesystem::path& file) { prepared.inputs.insert(file); }};
  return {experiment.localizer, catalog, setup, experiment.seed};
}

std::vector<std::size_t> count_trials(std::vector<Variant>& variants, Preparer& preparer,
                                      const Catalog& catalog) {
  std::vector<std::size_t> trials;
  std::set<Fault> seen;  // Many variants may have the same fault.
  std::vector<Fault> faults;
  for (Variant& variant : variants) {
    try {
      Prepared& prepared = preparer.prepare(variant.experiment);
      trials.push_back(prepared.starts.size());
      if (variants.size() > 1) static_cast<void>(make_localizer(variant.experiment, catalog, prepared));
    } catch (const ConfigError& error) {
      for (Fault fault : error.faults()) {
        if (!seen.insert(fault).second) continue;
        if (!variant.name.empty())
          fault.message = fmt::format("variant '{}': {}", variant.name, fault.message);
        faults.push_back(std::move(fault));
      }
    }
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return trials;
}

bool run_trials(std::vector<Localizer>& localizers, const Experiment& experiment, const Prepared& prepared,
                const std::vector<std::size_t>& trials, const RunCallbacks& callbacks) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  std::vector<std::exception_ptr> errors(localizers.size());
  const auto run_one = [&](Localizer& localizer, std::size_t trial) {
    const auto step = [&](const StepRecord& record, const Localizer& now) {
      callbacks.step(trial, record, now);
    };
    const auto stop = [&] { return stopped || callbacks.stop(); };
    const auto record = run_trial(localizer, prepared.drive, *prepared.map, experiment, trial,
                                  prepared.starts[trial], {step, stop});
    if (record) {
      callbacks.done(*record);
    } else {
      stopped = true;
    }
  };
  const auto work = [&](std::size_t job) {
    try {
      for (std::size_t i = next++; i < trials.size() && !stopped; i = next++)
        run_one(localizers[job], trials[i]);
    } catch (...) {
      errors[job] = std::current_exception();
      stopped = true;
    }
  };
  {
    // Threads of their own, not tasks: one that waits for its step's threads must not begin another trial.
    std::vector<std::jthread> others;
    for (std::size_t job = 1; job < localizers.size(); ++job) others.emplace_back(work, job);
    work(0);
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return !stopped;
}

}  // namespace glocal
