#include "evaluation/running/variant_run.hpp"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "evaluation/results/map_changes.hpp"
#include "evaluation/results/map_files.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/writers.hpp"
#include "evaluation/running/elapsed.hpp"
#include "evaluation/running/pins.hpp"

namespace glocal {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

VariantRun::VariantRun(Variant& variant, ExperimentLoader& loader, const std::filesystem::path& file,
                       const RunOptions& options)
    : variant_(variant),
      loader_(loader),
      file_(file),
      options_(options),
      loaded_(loader.load(variant.experiment)) {
  check_pins(variant, loaded_, loader.hashes());
  const auto start = Clock::now();
  localizers_.push_back(make_localizer(variant.experiment, loader.catalog(), loaded_));
  map_index_ms_ = ms_since(start);
}

std::set<std::filesystem::path> VariantRun::inputs() const {
  std::set<std::filesystem::path> inputs = loaded_.inputs;
  if (!file_.empty()) inputs.insert(file_);
  inputs.insert(options_.plugins.begin(), options_.plugins.end());
  return inputs;
}

Json VariantRun::description() const {
  Experiment& experiment = variant_.experiment;
  Json map = {{"points", loaded_.map->points().size()},
              {"build_ms", loaded_.map_build_ms},
              {"index_ms", map_index_ms_}};
  if (const auto index = localizer().map_index())
    map["index"] = {{"entries", index->entries}, {"bytes", index->bytes}, {"build_ms", index->build_ms}};
  return {
      {"effective", effective_yaml(experiment, loader_.catalog(), *loaded_.map)},
      {"provenance", provenance_of_run(loader_.catalog(), variant_, options_, inputs(), loader_.hashes())},
      {"name", experiment.name},
      {"seed", experiment.seed},
      {"steps", experiment.output.steps},
      {"map", std::move(map)},
      {"peak_rss_mb", peak_rss_mb()}};
}

bool VariantRun::run(const std::string& identity, const std::vector<std::size_t>& trials, Journal& journal,
                     const RunCallbacks& callbacks, bool with_map) {
  const Experiment& experiment = variant_.experiment;
  const auto jobs = static_cast<std::size_t>(std::max(options_.jobs, 1));
  while (localizers_.size() < std::min(jobs, trials.size()))
    localizers_.push_back(make_localizer(experiment, loader_.catalog(), loaded_));
  TrialCollector collector(experiment.output);
  std::vector<Clock::time_point> begun(loaded_.starts.size());
  const auto id = [&](std::size_t trial) { return trial_id(identity, trial, loaded_.starts[trial]); };
  RunCallbacks run;
  run.stop = callbacks.stop;
  run.begin = [&](std::size_t trial) {
    const TrialRecord record =
        begun_trial(loaded_.drive, experiment.localizer.motion, trial, loaded_.starts[trial]);
    journal.begin(id(trial), start_json(record));
    begun[trial] = Clock::now();
  };
  run.step = [&](std::size_t trial, const StepRecord& record, const Localizer& now) {
    const Sample& sample = loaded_.drive.samples[loaded_.starts[trial] + record.result.step];
    collector.step(trial, record, sample.observation.scan, now);
    callbacks.step(trial, record, now);
  };
  run.done = [&](const TrialRecord& record) {
    TrialOutput output = collector.finish(record);
    if (with_map && record.trial == 0 && experiment.output.maps != "none") {
      for (auto& file : map_files(*loaded_.map)) output.files.push_back(std::move(file));
    }
    if (collector.keeps_map(record.trial)) {
      if (auto changes = changes_json(record, loaded_.drive, *loaded_.map))
        output.files.emplace_back(changes_file(record.trial), *std::move(changes));
    }
    journal.finish(id(record.trial), ms_since(begun[record.trial]), output);
    callbacks.done(record);
  };
  return run_trials(localizers_, experiment, loaded_, trials, run);
}

}  // namespace glocal
