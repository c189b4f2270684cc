// glocal run --shard: one share of an experiment, into a folder that all shards share.
#pragma once

#include <string>
#include <vector>

#include "app/commands.hpp"
#include "evaluation/sharding/shares.hpp"
#include "glocal/run_experiment.hpp"

namespace glocal::app {

/// "3/64". Throws ConfigError.
[[nodiscard]] Shard shard_of(const std::string& text);

/// Runs what is missing of the share, in processes that may crash; sets the exit code of the context. Throws
/// ConfigError for a folder of another experiment, RunError.
void run_shard(std::vector<Variant> variants, const std::string& file, const Shard& shard,
               const RunOptions& options, bool quiet, Context& context);

}  // namespace glocal::app
