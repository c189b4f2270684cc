// The subcommands of the program; each adds itself to the command line and runs when it is chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/error.hpp"
#include "loading/plugin_loader.hpp"

namespace glocal::app {

/// What a subcommand works with. `exit_code` is what the program ends with (0 done, 1 failed while running, 2
/// wrong usage or configuration, 3 incomplete); exceptions are turned into messages and codes in main().
struct Context {
  Catalog catalog;
  PluginLoader plugins{catalog};
  int exit_code = 0;
  std::string command_line;  ///< As a shell would read it, for the record of runs.
};

/// The registry of a kind; null if there is none, of which unknown_kind() tells.
[[nodiscard]] const RegistryBase* registry_of(const std::string& kind, const Catalog& catalog);
[[nodiscard]] Fault unknown_kind(const std::string& kind, const Catalog& catalog);

/// Adds --plugin, before and after every subcommand, and loads what it and GLOCAL_PLUGIN_PATH name before the
/// subcommand runs. To be called after the subcommands have been added.
void add_plugins(CLI::App& app, Context& context);

void add_bag(CLI::App& app, Context& context);
void add_check(CLI::App& app, Context& context);
void add_compare(CLI::App& app, Context& context);
void add_completion(CLI::App& app, Context& context);
void add_contract(CLI::App& app, Context& context);
void add_convert(CLI::App& app, Context& context);
void add_describe(CLI::App& app, Context& context);
void add_explain(CLI::App& app, Context& context);
void add_figures(CLI::App& app, Context& context);
void add_help(CLI::App& app, Context& context);
void add_leaderboard(CLI::App& app, Context& context);
void add_list(CLI::App& app, Context& context);
void add_live(CLI::App& app, Context& context);
void add_localize(CLI::App& app, Context& context);
void add_map(CLI::App& app, Context& context);
void add_mapping(CLI::App& app, Context& context);
void add_merge(CLI::App& app, Context& context);
void add_new_plugin(CLI::App& app, Context& context);
void add_prepare(CLI::App& app, Context& context);
void add_reference(CLI::App& app, Context& context);
void add_register(CLI::App& app, Context& context);
void add_reliability(CLI::App& app, Context& context);
void add_report(CLI::App& app, Context& context);
void add_run(CLI::App& app, Context& context);
void add_schema(CLI::App& app, Context& context);
void add_simulate(CLI::App& app, Context& context);
void add_status(CLI::App& app, Context& context);
void add_submit(CLI::App& app, Context& context);
void add_summarize(CLI::App& app, Context& context);
void add_sweep(CLI::App& app, Context& context);

}  // namespace glocal::app
