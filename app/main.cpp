// glocal: finds out where a mobile robot is on a known map from range scans and odometry.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <string>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/fatal_signals.hpp"
#include "app/job_scripts.hpp"
#include "app/standard_streams.hpp"
#include "glocal/builtin.hpp"
#include "version.hpp"

namespace {

void add_all(CLI::App& app, glocal::app::Context& context) {
  using namespace glocal::app;
  add_localize(app, context);
  add_run(app, context);
  add_status(app, context);
  add_merge(app, context);
  add_submit(app, context);
  add_check(app, context);
  add_help(app, context);
  add_list(app, context);
  add_describe(app, context);
  add_explain(app, context);
  add_summarize(app, context);
  add_sweep(app, context);
  add_compare(app, context);
  add_figures(app, context);
  add_register(app, context);
  add_reliability(app, context);
  add_report(app, context);
  add_schema(app, context);
  add_reference(app, context);
  add_simulate(app, context);
  add_map(app, context);
  add_bag(app, context);
  add_convert(app, context);
  add_prepare(app, context);
  add_mapping(app, context);
  add_new_plugin(app, context);
  add_completion(app, context);
  add_manual(app, context);
}

/// As a shell would read them.
std::string words_of(int argc, char** argv) {
  std::string words = "glocal";
  for (int i = 1; i < argc; ++i) words += " " + glocal::app::shell_word(argv[i]);
  return words;
}

}  // namespace

int main(int argc, char** argv) {
  glocal::app::keep_standard_streams();
  glocal::app::name_strategy_in_crashes();
  // A file that grows over the limit of the shell (ulimit -f) is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  // Answers go to stdout, everything else to stderr.
  spdlog::set_default_logger(spdlog::stderr_color_mt("glocal"));
  spdlog::set_pattern("%^%l%$: %v");
  glocal::app::Context context;
  context.command_line = words_of(argc, argv);
  glocal::register_builtin_strategies(context.catalog);
  CLI::App app("Finds out where a mobile robot is on a known map from range scans and odometry.", "glocal");
  app.set_version_flag("--version",
                       std::string("glocal ") + glocal::version + " (" + glocal::revision() + ")");
  app.require_subcommand(1);
  add_all(app, context);
  glocal::app::add_plugins(app, context);
  return glocal::app::run_command_line(app, context, argc, argv);
}
