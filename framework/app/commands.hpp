// The subcommands of the program; each adds itself to the command line and runs when it is chosen.
#pragma once

#include <CLI/CLI.hpp>

#include "glocal/catalog.hpp"

namespace glocal::app {

/// What a subcommand works with. `exit_code` is what the program ends with (0 done, 1 failed while running, 2
/// wrong usage or configuration, 3 incomplete); exceptions are turned into messages and codes in main().
struct Context {
  Catalog catalog;
  int exit_code = 0;
};

void add_check(CLI::App& app, Context& context);
void add_describe(CLI::App& app, Context& context);
void add_list(CLI::App& app, Context& context);
void add_map(CLI::App& app, Context& context);
void add_mapping(CLI::App& app, Context& context);
void add_reference(CLI::App& app, Context& context);
void add_run(CLI::App& app, Context& context);
void add_schema(CLI::App& app, Context& context);
void add_simulate(CLI::App& app, Context& context);

}  // namespace glocal::app
