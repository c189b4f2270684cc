// Runs trials of a shard, in one process.
#pragma once

#include <vector>

#include "evaluation/results/journal.hpp"
#include "evaluation/running/experiment_runner.hpp"
#include "evaluation/sharding/manifest.hpp"
#include "evaluation/sharding/shares.hpp"

namespace glocal {

/// Runs these trials, by their places in the manifest, as many at once as `options.jobs` says, and leaves in
/// the journal what they come to; false if stopped before the last. Throws ConfigError if an input file is
/// not what it was when the manifest was made, and RunError if the journal cannot be written.
bool run_shard_trials(std::vector<Variant>& variants, const Manifest& manifest,
                      const std::vector<PlannedTrial>& trials, const Catalog& catalog,
                      const RunOptions& options, Journal& journal, const RunnerCallbacks& callbacks);

}  // namespace glocal
