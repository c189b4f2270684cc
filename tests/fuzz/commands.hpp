// The program's commands, called as from a shell.
#pragma once

#include <string>
#include <vector>

namespace glocal::fuzz {

/// Runs the program with these arguments; an exit code other than 0, 1, 2 and 3 is a fault, and so is 1 if
/// nothing can fail while running.
void run_command(std::vector<std::string> arguments);

}  // namespace glocal::fuzz
