// glocal run: runs an experiment, or each of its variants, and leaves results in folders.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/interrupts.hpp"
#include "app/progress.hpp"
#include "app/run_report.hpp"
#include "app/run_shard.hpp"
#include "app/watch_server.hpp"
#include "config/reader.hpp"
#include "config/text_file.hpp"
#include "config/yaml_parser.hpp"
#include "evaluation/running/experiment_runner.hpp"
#include "report/live_run.hpp"

namespace glocal::app {
namespace {

/// What --watch stands for without a port.
constexpr const char* any_port = "any";

/// For whoever watches to hear that the run is over.
constexpr std::chrono::milliseconds longest_farewell{650};

struct RunCommand {
  ExperimentOptions experiment;
  RunOptions run;
  std::string shard;  ///< "3/64"; empty if this process runs all.
  std::string watch;  ///< Port, or any_port; empty if nobody may watch.
  bool quiet = false;
};

/// Tells whoever waits how far the run is: on the terminal, and to those who watch.
class Waiting {
 public:
  Waiting(bool quiet, LiveRun* live) : quiet_(quiet), live_(live) {}

  /// Good as long as this object is.
  RunnerCallbacks callbacks() {
    return {.counted = [this](std::size_t trials) { progress_.emplace(!quiet_, trials); },
            .begin = [this](const LoadedVariant& variant) { begin(variant); },
            .trials = {[this](std::size_t trial, const StepRecord& record, const Localizer& now) {
                         step(trial, record, now);
                       },
                       [this](const TrialRecord& record) { finish(record); }, is_interrupted},
            .note =
                [this](const std::string& text) {
                  if (!quiet_) spdlog::info(text);
                },
            .warn = [](const std::string& text) { spdlog::warn(text); }};
  }

  /// Takes the bar off the terminal.
  void end() { progress_.reset(); }

 private:
  void begin(const LoadedVariant& variant) {
    progress_->begin(variant.name);
    progress_->skip(variant.finished);
    longest_trial_ = std::min(variant.loaded.drive.samples.size(), step_limit(variant.experiment.trials));
    if (live_ != nullptr) live_->begin(variant.name, variant.folder, variant.settings, variant.loaded);
  }

  void step(std::size_t trial, const StepRecord& record, const Localizer& now) {
    const std::size_t step = record.result.step;
    progress_->step(trial, step, static_cast<double>(step) / static_cast<double>(longest_trial_),
                    to_string(record.result.verdict.kind));
    if (live_ != nullptr) live_->step(trial, record, now.local_map().points, progress_->now());
  }

  void finish(const TrialRecord& record) {
    progress_->finish(record.trial);
    if (live_ != nullptr) live_->finish(record, progress_->now());
    if (record.outcome == Outcome::failed)
      spdlog::error("trial {} failed in step {}: {}", record.trial, record.records.size(), record.why);
  }

  bool quiet_;
  LiveRun* live_;  ///< Null if nobody may watch.
  std::optional<Progress> progress_;
  std::size_t longest_trial_ = 1;  ///< Steps.
};

/// Whether nothing says which localizer is to be run.
bool names_no_localizer(const ExperimentOptions& options) {
  const auto is_of_localizer = [](const std::string& change) { return change.starts_with("localizer"); };
  if (options.file.empty() || !options.methods.empty() ||
      std::any_of(options.set.begin(), options.set.end(), is_of_localizer))
    return false;
  std::vector<Fault> faults;
  const auto tree = parse_yaml(read_text_file(options.file), origin_of(options.file), faults);
  return tree && find_entry(*tree, "localizer") == nullptr && find_entry(*tree, "methods") == nullptr;
}

void run(const RunCommand& command, Context& context) {
  std::optional<Shard> shard;
  if (!command.shard.empty()) shard = shard_of(command.shard);
  std::vector<Variant> variants = command.experiment.read_variants(command.experiment.file, context);
  if (!command.quiet && names_no_localizer(command.experiment))
    spdlog::info(
        "{} names no localizer: it is run with the paper's method; --method indexed takes that of glocal "
        "localize",
        command.experiment.file);
  RunOptions options = command.run;
  options.plugins = context.plugins.loaded();
  options.command = context.command_line;
  if (shard) {
    run_shard(std::move(variants), command.experiment.file, *shard, options, command.quiet, context);
    return;
  }
  LiveRun live(variants.front().experiment.name);
  std::optional<WatchServer> server;
  listen_to_interrupts();
  if (!command.watch.empty()) {
    server.emplace(command.watch == any_port ? 0 : std::stoi(command.watch), live);
    spdlog::info("watch: http://127.0.0.1:{}/", server->port());
  }
  Waiting waiting(command.quiet, server ? &live : nullptr);
  const RunResult result = ExperimentRunner(std::move(variants), command.experiment.file, context.catalog,
                                            std::move(options), waiting.callbacks())
                               .run();
  waiting.end();
  live.end();
  if (!is_interrupted()) live.wait_until_told(longest_farewell);
  context.exit_code = exit_code_of(result);
  if (!command.quiet) print_result(result);
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  auto options = std::make_shared<RunCommand>();
  CLI::App* command = app.add_subcommand(
      "run",
      "Run an experiment, or all its variants, and leave the results in a folder. Without a "
      "localizer it is the paper's method.");
  options->experiment.add_to(*command);
  CLI::Option* only = command->add_option("--only", options->run.only, "Run only this variant (repeatable)")
                          ->allow_extra_args(false);
  CLI::Option* out =
      command->add_option("-o,--out", options->run.out, "Folder for the results (default: results/NAME)");
  command
      ->add_option("--jobs", options->run.jobs,
                   "Trials that run side by side, each with --threads of its own")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  CLI::Option* watch =
      command
          ->add_flag(
              fmt::format("--watch{{{}}}", any_port), options->watch,
              "Show the run while it goes on, in a browser on this machine; --watch=PORT to choose where")
          ->check((CLI::IsMember({any_port, "0"}) | CLI::Range(1024, 65535)).description(""));
  CLI::Option* force =
      command->add_flag("--force", options->run.force, "Replace earlier results in that folder");
  command
      ->add_option("--shard", options->shard,
                   "Run one share of all trials, as 3/64, into a folder that all shards share")
      ->needs(out)
      ->excludes(only)
      ->excludes(watch)
      ->excludes(force);
  command->add_flag("--quiet", options->quiet, "No progress and no summary");
  command->callback([options, &context] { run(*options, context); });
}

}  // namespace glocal::app
