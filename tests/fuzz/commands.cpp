#include "fuzz/commands.hpp"

#include "app/command_line.hpp"
#include "app/standard_streams.hpp"
#include "fuzz/harness.hpp"
#include "glocal/builtin.hpp"

namespace glocal::fuzz {

void run_command(void (*add)(CLI::App&, app::Context&), std::vector<std::string> arguments) {
  static app::Context context;
  static const bool is_set_up = (app::log_to_stderr(), register_builtin_strategies(context.catalog), true);
  static_cast<void>(is_set_up);
  context.exit_code = 0;
  CLI::App program("", "glocal");
  add(program, context);
  std::reverse(arguments.begin(), arguments.end());  // As CLI11 wants them.
  const int code = app::exit_code_of([&] {
    try {
      program.parse(std::move(arguments));
    } catch (const CLI::ParseError&) {
    }
    return context.exit_code;
  });
  must_hold(code >= 0 && code <= 3, "an exit code that there is not");
}

}  // namespace glocal::fuzz
