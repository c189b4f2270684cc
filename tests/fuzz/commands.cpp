#include "fuzz/commands.hpp"

#include "app/command_line.hpp"
#include "app/standard_streams.hpp"
#include "fuzz/harness.hpp"

namespace glocal::fuzz {

void run_command(std::vector<std::string> arguments) {
  static const bool logs = (app::log_to_stderr(), true);
  static_cast<void>(logs);
  arguments.insert(arguments.begin(), "glocal");
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  const int code = app::run_program(static_cast<int>(words.size()), words.data());
  must_hold(code >= 0 && code <= 3, "an exit code that there is not");
}

}  // namespace glocal::fuzz
