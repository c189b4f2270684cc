// Runs trials of a shard, in one process.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/sharding/manifest.hpp"
#include "evaluation/sharding/shard_journal.hpp"
#include "evaluation/sharding/shares.hpp"
#include "glocal/catalog.hpp"
#include "glocal/run_experiment.hpp"

namespace glocal {

/// What to do while trials run, from several threads at once.
struct ShardCallbacks {
  std::function<void(const LoadedExperiment&, const std::string& variant)> begin;
  std::function<void(std::size_t trial, const StepRecord&)> step;
  std::function<void(const TrialRecord&)> done;
  std::function<bool()> stop;
  Warn warn;
};

/// Runs these trials, by their places in the manifest, as many at once as `options.jobs` says, and leaves in
/// the journal what they come to; false if stopped before the last. Throws ConfigError if an input file is
/// not what it was when the manifest was made, and RunError if the journal cannot be written.
bool run_shard_trials(std::vector<Variant>& variants, const Manifest& manifest,
                      const std::vector<PlannedTrial>& trials, const Catalog& catalog,
                      const RunOptions& options, ShardJournal& journal, const ShardCallbacks& callbacks);

}  // namespace glocal
