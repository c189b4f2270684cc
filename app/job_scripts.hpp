// The scripts that run a sharded experiment with a scheduler: plain text that people read, change and keep.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glocal::app {

/// How each shard is run: `glocal run --shard`, with what goes along. All paths are absolute.
struct ShardedRun {
  std::string name;  ///< Of the experiment.
  std::filesystem::path program, file, out;
  std::vector<std::filesystem::path> plugins = {};
  std::vector<std::string> options = {};  ///< What else says the experiment: --set, PATH=VALUE and so on.
  /// Where relative paths of options start, and what GLOCAL_DATASETS says; empty if it is not set.
  std::filesystem::path working_folder = {};
  std::string datasets = {};
  int shards = 1;
  int jobs = 1;   ///< Trials of a shard that run side by side.
  int cores = 1;  ///< That a shard keeps busy.
};

/// What Slurm is asked for.
struct SlurmJob {
  int tasks = 1;                          ///< Of the array; not more than shards.
  std::optional<int> limit = {};          ///< Tasks that run at once.
  std::string time = {};                  ///< For a task; empty: what the partition says.
  std::vector<std::string> options = {};  ///< Further ones of sbatch, one each.
};

/// What GNU parallel is asked for.
struct ParallelJob {
  std::filesystem::path hosts = {};  ///< File for --sshloginfile; empty: this machine alone.
  std::optional<int> limit = {};     ///< Shards that run at once on each machine.
};

/// Scripts and what they leave, in the folder of the shared folder that has what shards need.
inline constexpr const char* array_file = "array.sbatch";
inline constexpr const char* merge_file = "merge.sbatch";
inline constexpr const char* parallel_file = "parallel.sh";
inline constexpr const char* shard_file = "shard.sh";
inline constexpr const char* joblog_file = "joblog";
inline constexpr const char* logs_folder = "logs";

/// The array of tasks that run all shards. With fewer tasks than shards each runs several, one after the
/// other.
[[nodiscard]] std::string array_script(const ShardedRun& run, const SlurmJob& job);
/// The job that puts the results together when all tasks are over.
[[nodiscard]] std::string merge_script(const ShardedRun& run, const SlurmJob& job);

/// What GNU parallel runs for each shard, with its number as argument.
[[nodiscard]] std::string shard_script(const ShardedRun& run);
/// Runs all shards, and puts the results together.
[[nodiscard]] std::string parallel_script(const ShardedRun& run, const ParallelJob& job);

/// As a word of a shell's command: quoted, unless it needs no quotes.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace glocal::app
