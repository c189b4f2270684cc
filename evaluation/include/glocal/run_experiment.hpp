// Runs whole experiments, as the program's command `run` does: link glocal::evaluation.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/experiment.hpp"
#include "glocal/outcome.hpp"
#include "glocal/pose3.hpp"
#include "glocal/step_result.hpp"

namespace glocal {

/// How an experiment is run. Nothing of this changes its results.
struct RunOptions {
  /// Folder for the results; results/NAME without it. Each variant has a folder of its own in there.
  std::filesystem::path out = {};
  std::vector<std::string> only = {};  ///< Names of the variants to run; all of them without any.
  int jobs = 1;                        ///< Trials that run side by side, each with the experiment's threads.
  bool force = false;                  ///< Replace earlier results that are in the way.
  /// Files that strategies of the catalog come from. Their hashes are noted with those of all other inputs:
  /// where one has changed, an unfinished run is not gone on with.
  std::vector<std::filesystem::path> plugins = {};
  /// The same of which the hash is known: plugins, the experiment's own file, and, by a name, what is in
  /// no file.
  std::map<std::string, std::string> sources = {};
  std::string command = {};  ///< How the user asked for the run, for its record.
};

/// A variant that is about to run.
struct VariantBegin {
  std::string name;  ///< Empty for an experiment without variants.
  std::filesystem::path folder;
  std::size_t trials = 0;
  std::size_t finished = 0;  ///< Of these, by an earlier run that was stopped.
};

/// A trial that is over.
struct TrialEnd {
  std::size_t trial = 0;
  Outcome outcome = Outcome::undecided;
  std::size_t steps = 0;      ///< Up to the declaration; all of them if there is none.
  double distance_m = 0.0;    ///< Driven in these steps.
  std::optional<Pose3> pose;  ///< Declared robot pose.
  std::string why;            ///< One sentence.
};

/// What to do while an experiment runs; each may be left as it is. With several jobs `step` and `trial` are
/// called from several threads at once, and for one trial from one of them. An exception ends the run, and is
/// thrown to the caller.
struct RunObserver {
  std::function<void(const VariantBegin&)> begin = [](const VariantBegin&) {};
  /// The result comes without its hypotheses, which can be tens of thousands.
  std::function<void(std::size_t trial, const StepResult&)> step = [](std::size_t, const StepResult&) {};
  std::function<void(const TrialEnd&)> trial = [](const TrialEnd&) {};
  /// Sentences for a person: what is kept of earlier runs, and what the user should know.
  std::function<void(const std::string&)> note = [](const std::string&) {};
  std::function<void(const std::string&)> warn = [](const std::string&) {};
  /// Asked before each step; true ends the run in good order. Finished trials are kept.
  std::function<bool()> stop = [] { return false; };
};

/// What a variant has come to.
struct VariantResult {
  std::string name;  ///< Empty for an experiment without variants.
  std::filesystem::path folder;
  std::filesystem::path summary;  ///< The file summary.json in the folder.
  bool complete = false;          ///< False if it was stopped before the last trial.
  std::size_t trials = 0;         ///< Those that are finished.
  std::size_t right = 0, wrong = 0, undecided = 0;
  std::size_t declared = 0;  ///< Without a reference to judge by.
  std::size_t failed = 0;
};

/// What an experiment has come to.
struct RunResult {
  std::filesystem::path folder;         ///< Of the results.
  std::vector<VariantResult> variants;  ///< In the order of the file. Those that were not begun are missing.
  bool complete = false;                ///< No variant, and no trial, is missing.
};

/// Runs an experiment file, or all its variants. `overrides` are as in read_experiment(). Goes on with what
/// an earlier run of the same values has left unfinished. Throws ConfigError for what is wrong with the
/// experiment, its inputs or the folder before anything is written, and RunError if results cannot be
/// written. A strategy that throws lets its trial fail, not the run.
[[nodiscard]] RunResult run_experiment(const std::filesystem::path& file,
                                       const std::vector<Override>& overrides, const Catalog& catalog,
                                       const RunOptions& options = {}, const RunObserver& observer = {});

/// The same for what read_variants() has made of a file: at least one, each of which may have been changed
/// since.
[[nodiscard]] RunResult run_variants(std::vector<Variant> variants, const std::filesystem::path& file,
                                     const Catalog& catalog, const RunOptions& options = {},
                                     const RunObserver& observer = {});

}  // namespace glocal
