// glocal submit: runs an experiment in shards, with Slurm or GNU parallel.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/interrupts.hpp"
#include "app/job_scripts.hpp"
#include "app/programs.hpp"
#include "app/shard_plan.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

struct SubmitOptions {
  ExperimentOptions experiment;
  std::string out;
  int shards = 100;
  int jobs = 1;
  std::optional<int> limit;
  bool dry_run = false;
  bool slurm = false;
  std::string time;
  std::vector<std::string> sbatch_options;
  bool parallel = false;
  std::string hosts;
};

/// Without Slurm at hand scripts can be written all the same: this is what it says unless it is told
/// otherwise.
constexpr int usual_most_tasks = 1000;

std::string trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t first = text.find_first_not_of(space);
  return first == std::string_view::npos
             ? ""
             : std::string(text.substr(first, text.find_last_not_of(space) - first + 1));
}

/// What a program has said, or, if it has said nothing, how it has ended.
std::string words_of(const Ended& ended) {
  if (ended.error != 0) return std::strerror(ended.error);
  const std::string words = trimmed(ended.err.empty() ? ended.out : ended.err);
  return words.empty() ? fmt::format("exit code {}", ended.exit_code) : words;
}

/// What a program of Slurm says. Throws RunError with its words if it fails.
std::string ask_slurm(const std::vector<std::string>& words) {
  const Ended ended = ask_program(words);
  if (ended.error != 0 || ended.exit_code != 0)
    throw RunError(fmt::format("{} has failed:\n{}", words.front(), words_of(ended)));
  return ended.out;
}

/// Whoever wants to queue jobs does so where Slurm is.
void check_sbatch() {
  const Ended ended = ask_program({"sbatch", "--version"});
  if (ended.error == 0) return;
  throw ConfigError("--slurm",
                    fmt::format("sbatch cannot be run: {}; give this command where Slurm is, as on a login "
                                "node, or take --dry-run for the scripts alone, or --parallel",
                                words_of(ended)));
}

/// Debian has another program of that name, too.
void check_parallel() {
  const Ended ended = ask_program({"parallel", "--version"});
  if (ended.error == 0 && ended.out.starts_with("GNU parallel")) return;
  throw ConfigError("--parallel",
                    fmt::format("there is no GNU parallel ({}); install the package parallel",
                                ended.error == 0 ? "parallel is another program" : words_of(ended)));
}

/// How many tasks an array may have: each index must be less than MaxArraySize.
int most_tasks(bool dry_run) {
  const std::vector<std::string> words = {"scontrol", "show", "config"};
  const std::string config = dry_run ? ask_program(words).out : ask_slurm(words);
  constexpr std::string_view key = "\nMaxArraySize";
  const std::size_t line = config.find(key);
  if (line == std::string::npos) return usual_most_tasks;
  const int size = std::atoi(config.c_str() + config.find('=', line) + 1);
  if (size < 2) throw RunError("Slurm takes no arrays here (MaxArraySize); take --parallel");
  return size - 1;
}

/// As few tasks as all shards need if each takes equally many, and an array no more than `most`.
int tasks_for(int shards, int most) {
  const int shards_of_one = (shards + most - 1) / most;
  return (shards + shards_of_one - 1) / shards_of_one;
}

/// What would break the lines that it becomes part of.
void check_texts(const SubmitOptions& options, const fs::path& out) {
  std::vector<Fault> faults;
  const std::string folder = out.string();
  if (folder.find('\n') != std::string::npos || (options.slurm && folder.find('\\') != std::string::npos)) {
    faults.push_back(
        {folder, 0, 0,
         "the folder's name has a line break or a backslash, which Slurm does not take; choose another "
         "one with --out"});
  }
  constexpr std::string_view times = "0123456789:-";
  if (options.time.find_first_not_of(times) != std::string::npos) {
    faults.push_back({"--time " + options.time, 0, 0,
                      "is no time; give minutes, hours:minutes:seconds or days-hours, as in 1:00:00"});
  }
  for (const std::string& option : options.sbatch_options) {
    if (option.starts_with('-') && option.find('\n') == std::string::npos) continue;
    faults.push_back({"--sbatch-option " + option, 0, 0, "is no option of sbatch, as --partition=short is"});
  }
  if (options.parallel && !options.hosts.empty() && ::access(options.hosts.c_str(), R_OK) != 0)
    faults.push_back({options.hosts, 0, 0, "cannot be read: " + std::string(std::strerror(errno))});
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

/// How shards are run, as far as it is known before they are planned.
ShardedRun described(const SubmitOptions& options, const std::vector<Variant>& variants,
                     const Context& context) {
  ShardedRun run;
  run.name = variants.front().experiment.name;
  run.program = fs::read_symlink("/proc/self/exe");
  if (!options.experiment.file.empty()) run.file = fs::absolute(options.experiment.file).lexically_normal();
  run.out = fs::absolute(options.out.empty() ? "results/" + run.name : options.out).lexically_normal();
  run.plugins = context.plugins.loaded();
  run.options = options.experiment.words();
  run.working_folder = fs::current_path();
  if (const char* datasets = std::getenv("GLOCAL_DATASETS"); datasets != nullptr && *datasets != '\0')
    run.datasets = fs::absolute(datasets).lexically_normal();
  run.shards = options.shards;
  run.jobs = options.jobs;
  for (const Variant& variant : variants)
    run.cores = std::max(run.cores, options.jobs * variant.experiment.threads);
  return run;
}

/// Plans all shards, so that whatever is wrong with the experiment shows now; false if it is said.
bool plan(ShardedRun& run, std::vector<Variant>& variants, Context& context) {
  const auto manifest = planned_shards(variants, run.file, run.out, context);
  if (!manifest) return false;
  // There is no more to share out.
  const auto asked = static_cast<std::size_t>(run.shards);
  run.shards = static_cast<int>(std::clamp<std::size_t>(manifest->count_trials(), 1, asked));
  return true;
}

struct Script {
  fs::path file;
  std::string text;
};

/// Writes scripts, for other programs to find, and shows them.
void write_scripts(const fs::path& folder, const std::vector<Script>& scripts) {
  // Jobs do not start where the folder of their output is missing.
  std::vector<fs::path> changed;
  check_written(make_folders(folder / logs_folder, changed), folder / logs_folder);
  AtomicFiles files(true);
  for (const Script& script : scripts) files.add(script.file, script.text);
  files.commit();
  for (const Script& script : scripts) answer("{}:\n\n{}\n", script.file.string(), script.text);
}

void print_next(const ShardedRun& run) {
  answer(
      "How far they are:   glocal status {0} --watch\n"
      "If any is missing:  the same command again\n",
      shell_word(run.out.string()));
}

/// Two arrays at once would do the same work twice.
void check_queue(const fs::path& array) {
  const std::string queue =
      ask_slurm({"squeue", "--noheader", fmt::format("--user={}", ::getuid()), "--format=%F %o"});
  const std::string end = " " + array.string() + "\n";
  const std::size_t found = queue.find(end);
  if (found == std::string::npos) return;
  const std::size_t line = queue.rfind('\n', found) + 1;
  const std::string id = queue.substr(line, found - line);
  throw RunError(
      fmt::format("job {0} runs these shards already: wait for it, or cancel it first (scancel {0})", id));
}

/// Queues a job, and returns its number.
std::string queued(const std::vector<std::string>& options, const fs::path& script) {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  words.insert(words.end(), options.begin(), options.end());
  words.push_back(script.string());
  const std::string answer = trimmed(ask_slurm(words));
  // With several clusters, the name of one follows.
  return answer.substr(0, answer.find(';'));
}

std::string queued_merge(const std::string& array, const fs::path& script) {
  try {
    return queued({"--dependency=afterany:" + array}, script);
  } catch (const RunError& error) {
    const Ended cancelled = ask_program({"scancel", array});
    const bool is_cancelled = cancelled.error == 0 && cancelled.exit_code == 0;
    throw RunError(fmt::format(
        "{}\nnote: job {}, the array before it, {}", error.what(), array,
        is_cancelled ? "has been cancelled" : "is queued still, as scancel failed: " + words_of(cancelled)));
  }
}

void submit_to_slurm(const SubmitOptions& options, Context& context) {
  if (!options.dry_run) check_sbatch();
  const int most = most_tasks(options.dry_run);
  std::vector<Variant> variants = options.experiment.read_variants(options.experiment.file, context);
  ShardedRun run = described(options, variants, context);
  check_texts(options, run.out);
  const fs::path folder = run.out / shards_folder;
  const fs::path array = folder / array_file;
  const fs::path merge = folder / merge_file;
  if (!options.dry_run) check_queue(array);
  if (!plan(run, variants, context)) return;
  const int tasks = tasks_for(run.shards, most);
  const SlurmJob job{tasks, options.limit, options.time, options.sbatch_options};
  write_scripts(folder, {{array, array_script(run, job)}, {merge, merge_script(run, job)}});
  if (tasks < run.shards) {
    answer("Slurm takes at most {} tasks in an array: {} of them run {} shards, one after the other.\n", most,
           tasks, run.shards);
  }
  if (options.dry_run) {
    answer("Nothing is queued.\n");
    return;
  }
  const std::string array_id = queued({}, array);
  const std::string merge_id = queued_merge(array_id, merge);
  answer("Queued: array {} runs the shards, then job {} puts the results together.\n", array_id, merge_id);
  print_next(run);
}

void submit_to_parallel(const SubmitOptions& options, Context& context) {
  if (!options.dry_run) check_parallel();
  std::vector<Variant> variants = options.experiment.read_variants(options.experiment.file, context);
  ShardedRun run = described(options, variants, context);
  check_texts(options, run.out);
  if (!plan(run, variants, context)) return;
  const fs::path folder = run.out / shards_folder;
  const fs::path script = folder / parallel_file;
  const fs::path hosts = options.hosts.empty() ? fs::path() : fs::absolute(options.hosts).lexically_normal();
  // It knows shards by their numbers alone, and nothing of what the experiment has got since then.
  std::error_code ignored;
  fs::remove(folder / joblog_file, ignored);
  write_scripts(folder, {{folder / shard_file, shard_script(run)},
                         {script, parallel_script(run, {hosts, options.limit})}});
  if (options.dry_run) {
    answer("Nothing is run.\n");
    return;
  }
  print_next(run);
  std::fflush(stdout);
  listen_to_interrupts();
  const int code = run_program({"sh", script.string()});
  const bool was_ended_by_signal = code > 128;
  context.exit_code = was_ended_by_signal && is_interrupted() ? 3 : code;
}

}  // namespace

void add_submit(CLI::App& app, Context& context) {
  auto options = std::make_shared<SubmitOptions>();
  CLI::App* command = app.add_subcommand(
      "submit", "Run an experiment in shards, with Slurm or GNU parallel, and put the results together.");
  options->experiment.add_to(*command);
  command->add_option("-o,--out", options->out, "Folder for the results (default: results/NAME)");
  command->add_option("--shards", options->shards, "In how many parts to run, at most one for each trial")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--jobs", options->jobs, "Trials of a shard that run side by side")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command
      ->add_option("--limit", options->limit,
                   "Shards that run at once: in all (Slurm), on each machine (GNU parallel)")
      ->check(CLI::Range(1, 1000000));
  command->add_flag("--dry-run", options->dry_run, "Write and show the scripts, but run and queue nothing");
  CLI::Option* slurm = command->add_flag("--slurm", options->slurm, "Queue the shards with Slurm");
  command->add_option("--time", options->time, "Time limit of a task, as sbatch takes it: 1:00:00")
      ->needs(slurm);
  command
      ->add_option("--sbatch-option", options->sbatch_options,
                   "Option for sbatch: --partition=short (repeatable)")
      ->allow_extra_args(false)
      ->needs(slurm);
  CLI::Option* parallel =
      command->add_flag("--parallel", options->parallel, "Run the shards with GNU parallel")->excludes(slurm);
  command
      ->add_option("--sshlogin", options->hosts,
                   "File with the machines to run on, one a line (GNU parallel)")
      ->needs(parallel);
  command->callback([options, &context] {
    if (!options->slurm && !options->parallel) {
      throw ConfigError("", "how are the shards to be run? Say --slurm or --parallel");
    }
    options->slurm ? submit_to_slurm(*options, context) : submit_to_parallel(*options, context);
  });
}

}  // namespace glocal::app
