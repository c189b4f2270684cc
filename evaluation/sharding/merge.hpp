// One set of results from what all shards have left.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/results/journal_scan.hpp"
#include "evaluation/sharding/manifest.hpp"
#include "glocal/run_experiment.hpp"

namespace glocal {

struct MissingTrials {
  std::string variant;
  std::vector<std::size_t> trials;  ///< Ascending.
};

struct MergeResult {
  RunResult run;  ///< As the run of one machine would have told.
  std::vector<MissingTrials> missing;
  [[nodiscard]] std::size_t count_missing() const;
};

struct MergeOptions {
  std::filesystem::path out;  ///< Where the results go; may be the shared folder.
  bool force = false;         ///< Replace results of other runs that are in the way.
  std::function<void(const std::string&)> note = [](const std::string&) {};
};

/// Writes the files that one run of the whole experiment leaves, the same but for times: memory and times of
/// the map are those of the shard that needed the most, or came first. Variants of which trials are missing
/// are marked as incomplete; those without any are left out. What an earlier call has written completely is
/// kept. Throws ConfigError for results of other runs that are in the way, and RunError.
[[nodiscard]] MergeResult merge_shards(const Manifest& manifest, const JournalScan& scan,
                                       const MergeOptions& options);

}  // namespace glocal
