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

/// Adds --plugin, before and after every subcommand, and loads what it and GLOCAL_PLUGIN_PATH name before the
/// subcommand runs. To be called after the subcommands have been added.
void add_plugins(CLI::App& app, Context& context);

/// Adds one subcommand, or some.
using AddCommands = void(CLI::App& app, Context& context);
AddCommands add_bag, add_check, add_compare, add_completion, add_contract, add_convert, add_describe,
    add_explain, add_figures, add_help, add_leaderboard, add_list, add_live, add_localize, add_map,
    add_mapping, add_merge, add_new_plugin, add_prepare, add_reference, add_register, add_reliability,
    add_report, add_run, add_schema, add_simulate, add_status, add_submit, add_summarize, add_sweep;

}  // namespace glocal::app
