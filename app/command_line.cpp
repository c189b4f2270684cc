#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.hpp"
#include "app/job_scripts.hpp"
#include "app/standard_streams.hpp"
#include "config/nearest.hpp"
#include "glocal/builtin.hpp"
#include "glocal/error.hpp"
#include "version.hpp"

namespace glocal::app {
namespace {

constexpr int failed = 1;
constexpr int wrong_input = 2;

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : subcommands_of(app)) {
    names.push_back(command->get_name());
  }
  return names;
}

int report(const ConfigError& error) {
  for (const Fault& fault : error.faults()) say("{}\n", to_string(fault));
  const std::size_t n = error.faults().size();
  say("{} {}\n", n, n == 1 ? "error" : "errors");
  return wrong_input;
}

/// What was another option in earlier versions.
struct RenamedOption {
  std::string_view command, before, now;
};
constexpr std::array<RenamedOption, 2> renamed_options = {
    {{"compare", "--csv", "-o FILE.csv"}, {"compare", "--markdown", "-o FILE.md"}}};

/// The command that was chosen, below all others.
const CLI::App& chosen_command(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : chosen_command(*chosen.front());
}

/// What to write for an argument that the command does not take; empty if nobody knows.
std::string advice_on(const std::string& argument, const CLI::App& command) {
  for (const RenamedOption& option : renamed_options) {
    const bool is_this = argument == option.before || argument.starts_with(std::string(option.before) + "=");
    if (command.get_name() == option.command && is_this)
      return fmt::format("; {} is called {} now", option.before, option.now);
  }
  const bool writes = command.get_option_no_throw("--out") != nullptr;
  return writes && !argument.starts_with("-") ? "; -o says what to write" : "";
}

int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = chosen_command(app);
  const std::vector<std::string> below = command_names(command);
  const std::vector<std::string> extras = app.remaining(true);
  if (!below.empty() && !extras.empty() && !extras.front().starts_with("-")) {
    say("error: unknown command '{}'{}\n", extras.front(), suggestion(extras.front(), below, "there are"));
    return wrong_input;
  }
  if (error.get_exit_code() == 0) {  // --help, --version
    app.exit(error);
    flush_answers();
    return 0;
  }
  if (!below.empty() && extras.empty() && error.get_name() == "RequiredError") {
    say("error: which command of {}?{}\n", command.get_name(), suggestion("", below, "there are"));
    return wrong_input;
  }
  say("error: {}{}\nRun with --help for more information.\n", error.what(),
      extras.empty() ? "" : advice_on(extras.front(), command));
  return wrong_input;
}

/// In the order in which help names them.
void add_all(CLI::App& app, Context& context) {
  for (const auto& add :
       {add_live,      add_localize, add_run,         add_status,     add_merge,    add_submit,
        add_check,     add_help,     add_leaderboard, add_list,       add_describe, add_explain,
        add_summarize, add_sweep,    add_compare,     add_figures,    add_register, add_reliability,
        add_report,    add_schema,   add_reference,   add_simulate,   add_map,      add_bag,
        add_convert,   add_prepare,  add_mapping,     add_new_plugin, add_contract, add_completion})
    add(app, context);
}

/// As a shell would read them.
std::string words_of(int argc, char** argv) {
  std::string words = "glocal";
  for (int i = 1; i < argc; ++i) words += " " + shell_word(argv[i]);
  return words;
}

/// An option with nothing behind it, as "$OUT" where that is not set, would be as if it were not there.
void check_no_empty_word(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto empty = std::find(words.begin(), words.end(), "");
  if (empty == words.end() || words.front() == "complete") return;
  throw ConfigError("glocal",
                    fmt::format("an argument is empty: the one after '{}'; give it a value, or leave "
                                "it out",
                                empty == words.begin() ? "glocal" : *std::prev(empty)));
}

int parse_and_run(CLI::App& app, const Context& context, int argc, char** argv) {
  if (argc <= 1) {
    answer(app.help());
    flush_answers();
    return 0;
  }
  check_no_empty_word(argc, argv);
  try {
    app.parse(argc, argv);
    flush_answers();
    return context.exit_code;
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  }
}

}  // namespace

std::vector<const CLI::App*> subcommands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* /*any*/) { return true; });
}

std::vector<const CLI::App*> shown_subcommands(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
}

int run_program(int argc, char** argv) {
  Context context;
  context.command_line = words_of(argc, argv);
  register_builtin_strategies(context.catalog);
  CLI::App app("Finds out where a mobile robot is on a known map from range scans and odometry.", "glocal");
  app.set_version_flag("--version", std::string("glocal ") + version + " (" + revision() + ")");
  app.require_subcommand(1);
  add_all(app, context);
  add_plugins(app, context);
  return exit_code_of([&] { return parse_and_run(app, context, argc, argv); });
}

int exit_code_of(const std::function<int()>& work) {
  try {
    return work();
  } catch (const ConfigError& error) {
    return report(error);
  } catch (const std::bad_alloc&) {
    say("error: not enough memory: free some, or ask for less at once (fewer trials, threads or jobs; a "
        "smaller map)\n");
    return failed;
  } catch (const std::exception& error) {
    say("error: {}\n", error.what());
    return failed;
  } catch (...) {
    say("error: a plugin threw something that is no std::exception\n");
    return failed;
  }
}

}  // namespace glocal::app
