// From arguments to an exit code.
#pragma once

#include <functional>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): as the library has it
class App;
}

namespace glocal::app {

/// The commands below one.
[[nodiscard]] std::vector<const CLI::App*> subcommands_of(const CLI::App& command);
/// Those of them that are meant for people.
[[nodiscard]] std::vector<const CLI::App*> shown_subcommands(const CLI::App& command);

/// The program: parses its arguments and runs the command they name. What goes wrong is said on stderr, and
/// in the exit code: 1 failed while running, 2 wrong usage or configuration.
[[nodiscard]] int run_program(int argc, char** argv);

/// What `work` returns, or the code of what it throws, which is said on stderr.
[[nodiscard]] int exit_code_of(const std::function<int()>& work);

}  // namespace glocal::app
