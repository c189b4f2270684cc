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
