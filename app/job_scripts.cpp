#include "app/job_scripts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "evaluation/sharding/manifest.hpp"

namespace glocal::app {
namespace {

std::string shards_of(const ShardedRun& run) {
  return run.shards == 1 ? "the one shard" : fmt::format("the {} shards", run.shards);
}

/// What all scripts that run shards need before they do.
std::string surroundings(const ShardedRun& run) {
  std::string text;
  if (!run.datasets.empty()) text += fmt::format("export GLOCAL_DATASETS={}\n", shell_word(run.datasets));
  if (!run.options.empty()) {
    text += fmt::format("# Relative paths in options start here.\ncd {} || exit 2\n",
                        shell_word(run.working_folder.string()));
  }
  return text;
}

/// `shard` is the shell's expression for its number.
std::string run_command(const ShardedRun& run, std::string_view shard) {
  std::string text = shell_word(run.program.string());
  for (const auto& plugin : run.plugins) text += " --plugin " + shell_word(plugin.string());
  text += " run";
  if (!run.file.empty()) text += " " + shell_word(run.file.string());
  for (const std::string& word : run.options) text += " " + shell_word(word);
  text += fmt::format(" --shard \"{}/{}\" --out {}", shard, run.shards, shell_word(run.out.string()));
  if (run.jobs != 1) text += fmt::format(" --jobs {}", run.jobs);
  return text;
}

std::string merge_command(const ShardedRun& run) {
  return fmt::format("{} merge {}", shell_word(run.program.string()), shell_word(run.out.string()));
}

/// A value of a line #SBATCH: sbatch reads quotes as a shell does, but nothing else.
std::string sbatch_word(std::string_view text) {
  std::string word = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') word += '\\';
    word += c;
  }
  return word + '"';
}

/// A file for a job's output; in the folder's name a % is no placeholder.
std::string log_of(const ShardedRun& run, std::string_view name) {
  std::string folder;
  for (const char c : (run.out / shards_folder / logs_folder).string())
    folder += c == '%' ? "%%" : std::string(1, c);
  return sbatch_word(fmt::format("{}/{}", folder, name));
}

/// Options of both jobs.
std::string common_options(const SlurmJob& job) {
  std::string text;
  if (!job.time.empty()) text += fmt::format("#SBATCH --time={}\n", job.time);
  for (const std::string& option : job.options) text += fmt::format("#SBATCH {}\n", option);
  return text;
}

std::string head_of_array(const ShardedRun& run, const SlurmJob& job) {
  const std::filesystem::path folder = run.out / shards_folder;
  std::string text = fmt::format(
      "#!/bin/bash\n"
      "# Runs {} of {} as an array of {}. Written by glocal submit, which queues it with\n"
      "#   sbatch --parsable {}\n"
      "#   sbatch --dependency=afterany:ID {}\n"
      "# where ID is what the first one prints. Whoever queues it again runs only what is missing.\n",
      shards_of(run), run.name, job.tasks == 1 ? "1 task" : fmt::format("{} tasks", job.tasks),
      shell_word((folder / array_file).string()), shell_word((folder / merge_file).string()));
  text += fmt::format("#SBATCH --job-name=glocal_{}\n#SBATCH --array=1-{}", run.name, job.tasks);
  if (job.limit) text += fmt::format("%{}", *job.limit);
  text += fmt::format(
      "\n#SBATCH --cpus-per-task={}\n"
      "#SBATCH --output={}\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --requeue\n",
      run.cores, log_of(run, "%A_%a.log"));
  return text + common_options(job);
}

constexpr const char* about_signals =
    R"(# A task may be killed or requeued at any time: finished trials are kept. When its time is over, Slurm sends
# SIGTERM to all of its processes, and SIGKILL 30 s later (KillWait). glocal then ends after the step under
# way, so no --signal is needed.
)";

}  // namespace

std::string shell_word(std::string_view text) {
  constexpr std::string_view plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=:,./@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string array_script(const ShardedRun& run, const SlurmJob& job) {
  const std::string text = head_of_array(run, job) + about_signals + surroundings(run);
  if (job.tasks == run.shards) return text + "exec " + run_command(run, "$SLURM_ARRAY_TASK_ID") + "\n";
  return text +
         fmt::format(
             "# Slurm takes no more tasks in an array: each runs several shards, one after the other.\n"
             "code=0\n"
             "for ((shard = SLURM_ARRAY_TASK_ID; shard <= {}; shard += {})); do\n"
             "  {} || code=$?\n"
             "  # 1 means that a trial has failed: the other shards are run all the same.\n"
             "  [ \"$code\" -le 1 ] || break\n"
             "done\n"
             "exit \"$code\"\n",
             run.shards, job.tasks, run_command(run, "$shard"));
}

std::string merge_script(const ShardedRun& run, const SlurmJob& job) {
  return fmt::format(
             "#!/bin/bash\n"
             "# Puts the results of {} of {} together, and says what is missing. Written by glocal submit.\n"
             "#SBATCH --job-name=glocal_merge_{}\n"
             "#SBATCH --output={}\n"
             "#SBATCH --open-mode=append\n",
             shards_of(run), run.name, run.name, log_of(run, "merge_%j.log")) +
         common_options(job) + "exec " + merge_command(run) + "\n";
}

std::string shard_script(const ShardedRun& run) {
  return fmt::format(
             "#!/bin/sh\n"
             "# Runs one of {} of {}; its number is the argument. Written by glocal submit.\n",
             shards_of(run), run.name) +
         surroundings(run) + "exec " + run_command(run, "$1") + "\n";
}

std::string parallel_script(const ShardedRun& run, const ParallelJob& job) {
  std::string options = "--joblog " + std::string(joblog_file) + " --resume-failed";
  if (job.limit) {
    options += fmt::format(" --jobs {}", *job.limit);
  } else if (run.cores > 1) {
    // Without it there is a shard for each core.
    options += fmt::format(" --jobs {}%", std::max(1, 100 / run.cores));
  }
  if (!job.hosts.empty()) options += " --workdir . --sshloginfile " + shell_word(job.hosts.string());
  const std::filesystem::path folder = run.out / shards_folder;
  return fmt::format(
      "#!/bin/sh\n"
      "# Runs {} of {} with GNU parallel {}, then puts the results together. Written by\n"
      "# glocal submit. Again, for what is missing:\n"
      "#   sh {}\n"
      "cd {} || exit 2\n"
      "# Shards that ended well, by the joblog, are passed over; glocal submit begins a new one. What\n"
      "# became of the others, the merge says.\n"
      "seq {} | parallel {} sh {} {{}}\n"
      "exec {}\n",
      shards_of(run), run.name, job.hosts.empty() ? "on this machine" : "on several machines",
      shell_word((folder / parallel_file).string()), shell_word(folder.string()), run.shards, options,
      shard_file, merge_command(run));
}

}  // namespace glocal::app
