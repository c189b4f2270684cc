#include "app/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "config/nearest.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

constexpr int failed = 1;
constexpr int wrong_input = 2;

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App* /*any*/) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

/// Whether the first argument should be a command, but is none.
bool is_unknown(std::string_view argument, const std::vector<std::string>& commands) {
  return !argument.starts_with('-') &&
         std::find(commands.begin(), commands.end(), argument) == commands.end();
}

int report(const ConfigError& error) {
  for (const Fault& fault : error.faults()) fmt::print(stderr, "{}\n", to_string(fault));
  const std::size_t n = error.faults().size();
  fmt::print(stderr, "{} {}\n", n, n == 1 ? "error" : "errors");
  return wrong_input;
}

int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  fmt::print(stderr, "error: {}\nRun with --help for more information.\n", error.what());
  return wrong_input;
}

}  // namespace

int run_command_line(CLI::App& app, const Context& context, int argc, char** argv) {
  if (argc <= 1) {
    fmt::print("{}", app.help());
    return 0;
  }
  const std::vector<std::string> commands = command_names(app);
  if (is_unknown(argv[1], commands)) {
    fmt::print(stderr, "error: unknown command '{}'{}\n", argv[1],
               suggestion(argv[1], commands, "there are"));
    return wrong_input;
  }
  try {
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0) throw RunError("the answer could not be written to standard output");
    return context.exit_code;
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  } catch (const ConfigError& error) {
    return report(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return failed;
  } catch (...) {
    fmt::print(stderr, "error: a plugin threw something that is no std::exception\n");
    return failed;
  }
}

}  // namespace glocal::app
