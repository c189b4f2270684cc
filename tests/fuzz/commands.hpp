// The program's commands, called as from a shell.
#pragma once

#include <string>
#include <vector>

#include "app/commands.hpp"

namespace glocal::fuzz {

/// Runs a command with these arguments, of which the first is its name. Building all commands each time would
/// take longer than most of them run.
void run_command(void (*add)(CLI::App&, app::Context&), std::vector<std::string> arguments);

}  // namespace glocal::fuzz
