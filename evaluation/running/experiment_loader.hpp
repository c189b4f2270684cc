// A whole experiment: everything loaded, then trial after trial.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/results/provenance.hpp"
#include "evaluation/running/drive.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/catalog.hpp"
#include "glocal/experiment.hpp"
#include "glocal/global_map.hpp"

namespace glocal {

/// What an experiment needs besides its configuration; shared read-only by all trials.
struct LoadedExperiment {
  std::shared_ptr<const GlobalMap> map;
  double map_build_ms = 0.0;
  Drive drive;
  std::vector<std::size_t> starts;         ///< Samples at which trials start.
  std::size_t all_starts = 0;              ///< That there are, of which trials.only may have chosen some.
  std::set<std::filesystem::path> inputs;  ///< Files that were read.
};

/// The map of an experiment, and its drive, from their sources. The experiment's seed overrules that of the
/// setup. Throw ConfigError, also where a source breaks its contract.
[[nodiscard]] MapData load_map(const Experiment& experiment, const Catalog& catalog, SourceSetup setup);
[[nodiscard]] Drive load_drive(const Experiment& experiment, const Catalog& catalog, SourceSetup setup);

/// Loads map and drive, brings reference poses on one of several maps to the common frame of these, and finds
/// the starts. Throws ConfigError.
[[nodiscard]] LoadedExperiment load_experiment(
    const Experiment& experiment, const Catalog& catalog, const Warn& warn,
    const TellProgress& progress = [](double) {});

/// Prepares one experiment after the other. The map is loaded again only where it is another one than that of
/// the experiment before, and so is the drive.
class ExperimentLoader {
 public:
  ExperimentLoader(
      const Catalog& catalog, Warn warn, TellProgress progress = [](double) {})
      : catalog_(catalog), warn_(std::move(warn)), progress_(std::move(progress)) {}

  /// Good until the next call. The map has indexes only if another experiment with the same localizer has
  /// built them: the time to build what a method looks up is its own. Throws ConfigError.
  LoadedExperiment& load(const Experiment& experiment);
  [[nodiscard]] const Catalog& catalog() const { return catalog_; }
  [[nodiscard]] FileHashes& hashes() { return hashes_; }

 private:
  void load_map(const Experiment& experiment);
  void load_drive(const Experiment& experiment);

  const Catalog& catalog_;
  Warn warn_;
  TellProgress progress_;
  std::string map_, drive_, localizer_;  ///< What they follow from, as YAML; empty before they are loaded.
  std::set<std::filesystem::path> map_inputs_, drive_inputs_;
  LoadedExperiment loaded_;
  FileHashes hashes_;
};

/// The localizer of an experiment on its map; files that its stages read are added to the inputs. Throws
/// ConfigError.
[[nodiscard]] Localizer make_localizer(const Experiment& experiment, const Catalog& catalog,
                                       LoadedExperiment& loaded);

/// Why no trial of an experiment can declare a pose, however good it is, and what to do about it, a sentence;
/// none if one can.
[[nodiscard]] std::optional<std::string> why_never_declared(const Experiment& experiment,
                                                            const LoadedExperiment& loaded,
                                                            const Localizer& localizer);

/// Places of variants, in an order in which those with the same map follow each other, and among them those
/// with the same drive: these are loaded once then.
[[nodiscard]] std::vector<std::size_t> loading_order(const std::vector<Variant>& variants,
                                                     const Catalog& catalog);

/// Loads one variant after the other, in loading_order(), and hands them over by their places. Throws
/// ConfigError with the faults of all, those of check_pins() and `work` too, each once.
void for_each_loaded(std::vector<Variant>& variants, ExperimentLoader& loader,
                     const std::function<void(std::size_t variant, LoadedExperiment&)>& work);

/// Hears of a variant that has been prepared.
using Prepared = std::function<void(std::size_t variant, LoadedExperiment&, const Localizer&)>;

/// Prepares every variant and, if there are several or somebody wants it, makes its localizer: whatever one
/// of them cannot work with shows before the first is run. Of a suite that is pinned, one variant does for
/// all with its map and its localizer, and, if somebody wants to know it, its case. Tells how many trials
/// each has. Throws ConfigError with the faults of all.
[[nodiscard]] std::vector<std::size_t> count_trials(std::vector<Variant>& variants, ExperimentLoader& loader,
                                                    const Prepared& prepared = {});

/// What to do while trials run side by side: calls come from several threads at once, those about one trial
/// from one.
struct RunCallbacks {
  std::function<void(std::size_t trial, const StepRecord&, const Localizer&)> step;
  std::function<void(const TrialRecord&)> done;
  std::function<bool()> stop;  ///< Asked before each step; true gives up all running trials.
  std::function<void(std::size_t trial)> begin = [](std::size_t) {};
};

/// Runs the trials of these numbers in their order, as many at once as there are localizers (all of the
/// experiment); false if stopped before the last. An exception of a callback ends all trials and is thrown
/// here.
bool run_trials(std::vector<Localizer>& localizers, const Experiment& experiment,
                const LoadedExperiment& loaded, const std::vector<std::size_t>& trials,
                const RunCallbacks& callbacks);

}  // namespace glocal
