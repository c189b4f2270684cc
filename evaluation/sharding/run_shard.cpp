#include "evaluation/sharding/run_shard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "evaluation/results/map_files.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/trial_output.hpp"
#include "evaluation/results/writers.hpp"
#include "evaluation/running/elapsed.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

/// One process of a shard.
class ShardWorker {
 public:
  ShardWorker(const Manifest& manifest, const Catalog& catalog, const RunOptions& options,
              ShardJournal& journal, const ShardCallbacks& callbacks)
      : manifest_(manifest),
        catalog_(catalog),
        options_(options),
        journal_(journal),
        callbacks_(callbacks),
        loader_(catalog, callbacks.warn) {}

  /// `place` is that of the variant in the manifest; false if stopped.
  bool run(Variant& variant, std::size_t place, const std::vector<std::size_t>& trials);

 private:
  void check_inputs(const PlannedVariant& planned, Experiment& experiment, const LoadedExperiment& loaded);
  [[nodiscard]] Json description(Variant& variant, const LoadedExperiment& loaded, const Localizer& localizer,
                                 double map_index_ms);

  const Manifest& manifest_;
  const Catalog& catalog_;
  const RunOptions& options_;
  ShardJournal& journal_;
  const ShardCallbacks& callbacks_;
  ExperimentLoader loader_;
  FileHashes hashes_;
};

bool ShardWorker::run(Variant& variant, std::size_t place, const std::vector<std::size_t>& trials) {
  const PlannedVariant& planned = manifest_.variants[place];
  Experiment& experiment = variant.experiment;
  LoadedExperiment& loaded = loader_.load(experiment);
  const auto start = Clock::now();
  std::vector<Localizer> localizers;
  localizers.push_back(make_localizer(experiment, catalog_, loaded));
  const double map_index_ms = ms_since(start);
  check_inputs(planned, experiment, loaded);
  const auto jobs = static_cast<std::size_t>(std::max(options_.jobs, 1));
  while (localizers.size() < std::min(jobs, trials.size()))
    localizers.push_back(make_localizer(experiment, catalog_, loaded));

  if (!manifest_.file.empty()) loaded.inputs.insert(manifest_.file);
  loaded.inputs.insert(options_.plugins.begin(), options_.plugins.end());
  Json described = description(variant, loaded, localizers.front(), map_index_ms);
  journal_.add_variant(planned.identity, described);
  callbacks_.begin(loaded, planned.name);

  TrialCollector collector(experiment.output);
  std::mutex mutex;
  std::map<std::size_t, Clock::time_point> begun;
  const auto id = [&](std::size_t trial) { return id_of(planned, trial, manifest_.starts_of(place)[trial]); };
  RunCallbacks run;
  run.stop = callbacks_.stop;
  run.begin = [&](std::size_t trial) {
    journal_.begin(id(trial), start_json(begun_trial(loaded.drive, experiment.localizer.motion, trial,
                                                     loaded.starts[trial])));
    const std::lock_guard lock(mutex);
    begun[trial] = Clock::now();
  };
  run.step = [&](std::size_t trial, const StepRecord& record, const Localizer& now) {
    const Sample& sample = loaded.drive.samples[loaded.starts[trial] + record.result.step];
    collector.step(trial, record, sample.observation.scan, now);
    callbacks_.step(trial, record);
  };
  run.done = [&](const TrialRecord& record) {
    TrialOutput output = collector.finish(record);
    if (record.trial == 0 && experiment.output.maps != "none") {
      for (auto& file : map_files(*loaded.map)) output.files.push_back(std::move(file));
    }
    const auto since = [&] {
      const std::lock_guard lock(mutex);
      return begun.at(record.trial);
    }();
    journal_.finish(id(record.trial), ms_since(since), output);
    callbacks_.done(record);
  };
  const bool complete = run_trials(localizers, experiment, loaded, trials, run);
  // Once more, as memory has grown.
  described["peak_rss_mb"] = peak_rss_mb();
  journal_.add_variant(planned.identity, described);
  return complete;
}

/// Results of other files must not be put together.
void ShardWorker::check_inputs(const PlannedVariant& planned, Experiment& experiment,
                               const LoadedExperiment& loaded) {
  if (identity_of(experiment, loaded.inputs, options_.plugins, catalog_, hashes_) == planned.identity) return;
  std::vector<Fault> faults;
  const std::string way_out =
      "since the first shard has run; bring it back as it was, or run all shards into another folder";
  for (const std::filesystem::path& input : loaded.inputs) {
    const auto known = manifest_.inputs.find(input.string());
    if (known == manifest_.inputs.end() || known->second != hashes_.of(input))
      faults.push_back({input.string(), 0, 0, "has changed " + way_out});
  }
  if (faults.empty()) faults.push_back({manifest_.file, 0, 0, "reads other files " + way_out});
  throw ConfigError(std::move(faults));
}

/// What the files of a variant need besides its trials.
Json ShardWorker::description(Variant& variant, const LoadedExperiment& loaded, const Localizer& localizer,
                              double map_index_ms) {
  Experiment& experiment = variant.experiment;
  Json map = {
      {"points", loaded.map->points().size()}, {"build_ms", loaded.map_build_ms}, {"index_ms", map_index_ms}};
  if (const auto index = localizer.map_index())
    map["index"] = {{"entries", index->entries}, {"bytes", index->bytes}, {"build_ms", index->build_ms}};
  return {{"effective", effective_yaml(experiment, catalog_, *loaded.map)},
          {"provenance", provenance_of_run(catalog_, variant, options_, loaded.inputs, hashes_)},
          {"name", experiment.name},
          {"seed", experiment.seed},
          {"steps", experiment.output.steps},
          {"map", std::move(map)},
          {"peak_rss_mb", peak_rss_mb()}};
}

}  // namespace

bool run_shard_trials(std::vector<Variant>& variants, const Manifest& manifest,
                      const std::vector<PlannedTrial>& trials, const Catalog& catalog,
                      const RunOptions& options, ShardJournal& journal, const ShardCallbacks& callbacks) {
  std::map<std::size_t, std::vector<std::size_t>> of_variants;
  for (const PlannedTrial& place : trials) of_variants[place.variant].push_back(place.trial);
  const auto places = places_of(manifest);
  ShardWorker worker(manifest, catalog, options, journal, callbacks);
  for (const std::size_t i : loading_order(variants, catalog)) {
    const auto of_variant = of_variants.find(places.at(variants[i].name));
    if (of_variant == of_variants.end()) continue;
    if (callbacks.stop() || !worker.run(variants[i], of_variant->first, of_variant->second)) return false;
  }
  return true;
}

}  // namespace glocal
