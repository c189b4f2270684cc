#include "evaluation/running/experiment_loader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "evaluation/running/elapsed.hpp"
#include "evaluation/running/pins.hpp"
#include "evaluation/running/reference_fit.hpp"
#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/running_stage.hpp"
#include "pipeline/stage_contracts.hpp"

namespace glocal {
namespace {

/// Throws ConfigError, with the source's name, where what it delivers breaks its contract.
template <class Check>
void require_contract(const char* kind, const StrategyChoice& source, Check check) {
  try {
    check();
  } catch (const BrokenContract& broken) {
    throw ConfigError("", fmt::format("{} '{}' breaks its contract: {}", kind, source.name, broken.what()));
  }
}

/// What a map follows from, as YAML.
std::string map_yaml(const Experiment& experiment, const Catalog& catalog) {
  Experiment sources = default_experiment();
  sources.seed = experiment.seed;
  sources.map = experiment.map;
  sources.localizer.motion = experiment.localizer.motion;  // Sources must keep to it.
  return effective_yaml(sources, catalog);
}

/// What a drive follows from.
std::string drive_yaml(const Experiment& experiment, const Catalog& catalog) {
  Experiment sources = default_experiment();
  sources.seed = experiment.seed;
  sources.observations = experiment.observations;
  sources.localizer.motion = experiment.localizer.motion;
  return effective_yaml(sources, catalog);
}

/// What the indexes of a map follow from.
std::string localizer_yaml(const Experiment& experiment, const Catalog& catalog) {
  Experiment stages = default_experiment();
  stages.localizer = experiment.localizer;
  return effective_yaml(stages, catalog);
}

/// A reference pose on one of several maps goes to the common frame of these. One that does not say on which
/// it is goes: an error that nobody can tell is none.
void bring_to_common_frame(Drive& drive, const GlobalMap& map, const Warn& warn) {
  bool is_any_left_out = false;
  for (Sample& sample : drive.samples) {
    if (!sample.map_from_robot || (map.parts().empty() && sample.map.empty())) continue;
    if (sample.map.empty()) {
      sample.map_from_robot.reset();
      is_any_left_out = true;
      continue;
    }
    const auto part = std::ranges::find(map.parts(), sample.map, &MapPart::name);
    if (part == map.parts().end()) {
      std::vector<std::string> names;
      for (const MapPart& p : map.parts()) names.push_back(p.name);
      throw ConfigError(
          "",
          fmt::format("observations: reference poses are on a map '{}', and there is {}; name one that is "
                      "there",
                      sample.map,
                      names.empty() ? "only one map" : fmt::format("only {}", fmt::join(names, ", "))));
    }
    sample.map_from_robot = part->common_from_part * *sample.map_from_robot;
  }
  if (is_any_left_out)
    warn(
        "reference poses do not say which of the maps they are on: they are left out (the observation source "
        "'several' says it)");
}

bool is_several(const std::shared_ptr<const GlobalMap>& map) {
  return map != nullptr && !map->parts().empty();
}

SourceSetup source_setup(std::set<std::filesystem::path>& inputs, const Warn& warn,
                         const TellProgress& progress) {
  return {.warn = warn,
          .note_input = [&inputs](const std::filesystem::path& file) { inputs.insert(file); },
          .progress = progress};
}

}  // namespace

MapData load_map(const Experiment& experiment, const Catalog& catalog, SourceSetup setup) {
  setup.seed = seed_of(RandomPart::map_source, experiment);
  setup.motion = experiment.localizer.motion;
  std::string file;
  const auto note = setup.note_input;
  setup.note_input = [&](const std::filesystem::path& input) {
    if (file.empty()) file = input.string();
    note(input);
  };
  const RunningStage stage{.kind = catalog.map_sources.kind(), .name = experiment.map.name};
  const StageScope scope(&stage);
  MapData map = catalog.map_sources.make(experiment.map, setup)->load();
  if (const std::string fault = fault_of_map(map); !fault.empty())
    throw ConfigError(file, fmt::format("map source '{}': {}", experiment.map.name, fault));
  require_contract("map source", experiment.map, [&] { check_map(map, experiment.localizer.motion); });
  return map;
}

Drive load_drive(const Experiment& experiment, const Catalog& catalog, SourceSetup setup) {
  setup.seed = seed_of(RandomPart::observation_source, experiment);
  setup.motion = experiment.localizer.motion;
  const RunningStage stage{.kind = catalog.observation_sources.kind(), .name = experiment.observations.name};
  const StageScope scope(&stage);
  Drive drive = read_drive(*catalog.observation_sources.make(experiment.observations, setup));
  require_contract("observation source", experiment.observations, [&] {
    for (const Sample& sample : drive.samples) check_sample(sample, experiment.localizer.motion);
  });
  return drive;
}

LoadedExperiment load_experiment(const Experiment& experiment, const Catalog& catalog, const Warn& warn,
                                 const TellProgress& progress) {
  return std::move(ExperimentLoader(catalog, warn, progress).load(experiment));
}

LoadedExperiment& ExperimentLoader::load(const Experiment& experiment) {
  std::string map = map_yaml(experiment, catalog_);
  std::string drive = drive_yaml(experiment, catalog_);
  std::string localizer = localizer_yaml(experiment, catalog_);
  const bool is_new_map = map != map_;
  const bool was_several = is_several(loaded_.map);
  if (is_new_map) {
    load_map(experiment);
  } else if (localizer != localizer_) {
    loaded_.map = std::make_shared<const GlobalMap>(loaded_.map->data());
  }
  // Several maps have moved references to where they lie, or taken them away.
  const bool is_new_drive = drive != drive_ || (is_new_map && (was_several || is_several(loaded_.map)));
  map_ = std::move(map);
  localizer_ = std::move(localizer);
  if (is_new_drive) load_drive(experiment);
  drive_ = std::move(drive);
  loaded_.inputs = map_inputs_;
  loaded_.inputs.insert(drive_inputs_.begin(), drive_inputs_.end());
  if (is_new_map || is_new_drive) {
    const double epsilon = contact_epsilon_on(*loaded_.map, experiment.localizer);
    if (const auto doubt = doubt_of_references(loaded_.drive, *loaded_.map, epsilon)) warn_(*doubt);
  }
  const std::vector<std::size_t> all = trial_starts(experiment.trials, loaded_.drive, *loaded_.map);
  loaded_.all_starts = all.size();
  loaded_.starts = chosen_starts(experiment.trials, all);
  return loaded_;
}

void ExperimentLoader::load_map(const Experiment& experiment) {
  map_.clear();  // Until there is another one, should it be at fault.
  map_inputs_.clear();
  const auto start = std::chrono::steady_clock::now();
  loaded_.map = std::make_shared<const GlobalMap>(
      glocal::load_map(experiment, catalog_, source_setup(map_inputs_, warn_, progress_)));
  loaded_.map_build_ms = ms_since(start);
}

void ExperimentLoader::load_drive(const Experiment& experiment) {
  drive_.clear();
  drive_inputs_.clear();
  loaded_.drive = glocal::load_drive(experiment, catalog_, source_setup(drive_inputs_, warn_, progress_));
  bring_to_common_frame(loaded_.drive, *loaded_.map, warn_);
}

Localizer make_localizer(const Experiment& experiment, const Catalog& catalog, LoadedExperiment& loaded) {
  const StageSetup setup{
      .map = loaded.map, .threads = experiment.threads, .note_input = [&](const std::filesystem::path& file) {
        loaded.inputs.insert(file);
      }};
  return {experiment.localizer, catalog, setup, seed_of(RandomPart::localizer, experiment)};
}

std::optional<std::string> why_never_declared(const Experiment& experiment, const LoadedExperiment& loaded,
                                              const Localizer& localizer) {
  std::size_t longest = 0;
  for (const std::size_t start : loaded.starts)
    longest = std::max(longest, steps_left(loaded.drive, experiment.trials, start));
  if (longest >= localizer.least_steps()) return std::nullopt;
  const std::string& rule = experiment.localizer.verdict_rule.name;
  return fmt::format(
      "no trial can end with a declared pose: the verdict rule '{0}' declares none before step {1}, and no "
      "trial has more than {2}. Let it declare sooner (glocal describe {0}), or trials go on for longer "
      "(trials.max_steps, a longer drive)",
      rule, localizer.least_steps(), longest);
}

std::vector<std::size_t> loading_order(const std::vector<Variant>& variants, const Catalog& catalog) {
  std::map<std::string, std::size_t> firsts;  // The first variant that has this map, or this drive.
  std::vector<std::pair<std::size_t, std::size_t>> first_of;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const Experiment& experiment = variants[i].experiment;
    const auto first = [&](std::string yaml) { return firsts.try_emplace(std::move(yaml), i).first->second; };
    first_of.emplace_back(first("map: " + map_yaml(experiment, catalog)),
                          first("drive: " + drive_yaml(experiment, catalog)));
    order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return first_of[i]; });
  return order;
}

namespace {

/// Those of the variants that `order` names, one after the other.
void for_each_loaded(std::vector<Variant>& variants, const std::vector<std::size_t>& order,
                     ExperimentLoader& loader,
                     const std::function<void(std::size_t variant, LoadedExperiment&)>& work) {
  std::set<Fault> seen;  // Many variants may have the same fault.
  std::vector<Fault> faults;
  for (const std::size_t i : order) {
    try {
      LoadedExperiment& loaded = loader.load(variants[i].experiment);
      check_pins(variants[i], loaded, loader.hashes());
      work(i, loaded);
    } catch (const ConfigError& error) {
      for (Fault fault : error.faults()) {
        if (!seen.insert(fault).second) continue;
        if (!variants[i].name.empty())
          fault.message = fmt::format("variant '{}': {}", variants[i].name, fault.message);
        faults.push_back(std::move(fault));
      }
    }
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

/// How many trials a variant has; none where that is not known before it is loaded.
std::optional<std::size_t> known_trials(const Variant& variant) {
  if (!variant.suite || !variant.suite->is_pinned) return std::nullopt;
  const std::vector<double>& only = variant.experiment.trials.only;
  return only.empty() ? variant.suite->find_case(variant.case_name)->starts : only.size();
}

}  // namespace

void for_each_loaded(std::vector<Variant>& variants, ExperimentLoader& loader,
                     const std::function<void(std::size_t variant, LoadedExperiment&)>& work) {
  for_each_loaded(variants, loading_order(variants, loader.catalog()), loader, work);
}

std::vector<std::size_t> count_trials(std::vector<Variant>& variants, ExperimentLoader& loader,
                                      const Prepared& prepared) {
  const Catalog& catalog = loader.catalog();
  std::vector<std::size_t> trials(variants.size());
  std::vector<std::size_t> order = loading_order(variants, catalog);
  std::set<std::string> tried;  // Of what is known already, a localizer is made once on each map.
  std::erase_if(order, [&](std::size_t i) {
    const Experiment& experiment = variants[i].experiment;
    const auto known = known_trials(variants[i]);
    if (known) trials[i] = *known;
    const std::string of_case = prepared ? variants[i].case_name : "";
    return known &&
           !tried.insert(map_yaml(experiment, catalog) + localizer_yaml(experiment, catalog) + of_case)
                .second;
  });
  for_each_loaded(variants, order, loader, [&](std::size_t i, LoadedExperiment& loaded) {
    trials[i] = loaded.starts.size();
    if (variants.size() == 1 && !prepared) return;
    const Localizer localizer = make_localizer(variants[i].experiment, catalog, loaded);
    if (prepared) prepared(i, loaded, localizer);
  });
  return trials;
}

bool run_trials(std::vector<Localizer>& localizers, const Experiment& experiment,
                const LoadedExperiment& loaded, const std::vector<std::size_t>& trials,
                const RunCallbacks& callbacks) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  std::vector<std::exception_ptr> errors(localizers.size());
  const ProcessMark process;
  const auto run_one = [&](Localizer& localizer, std::size_t trial) {
    const auto step = [&](const StepRecord& record, const Localizer& now) {
      callbacks.step(trial, record, now);
    };
    const auto stop = [&] { return stopped || callbacks.stop(); };
    callbacks.begin(trial);
    const auto record = run_trial(localizer, loaded.drive, *loaded.map, experiment, trial,
                                  loaded.starts[trial], {step, stop});
    process.end_copies();
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
