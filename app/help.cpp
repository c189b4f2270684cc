// glocal help: of a command, or of what experiments are made of.
#include "config/help.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/standard_streams.hpp"
#include "config/nearest.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

void help_on(const std::string& topic, const CLI::App& app, const Catalog& catalog) {
  if (topic.empty()) {
    // app.help() would be that of the command that runs: this one.
    answer(app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
    return;
  }
  std::vector<std::string> commands;
  for (const CLI::App* command : subcommands_of(app)) {
    commands.push_back(command->get_name());
    if (command->get_name() != topic) continue;
    answer(command->help(app.get_name()));
    return;
  }
  if (const auto text = help(topic, catalog)) {
    answer(*text);
    return;
  }
  throw ConfigError("", "there is no command, strategy or part of an experiment called '" + topic + "'" +
                            suggestion(topic, commands, "there are the commands"));
}

}  // namespace

void add_help(CLI::App& app, Context& context) {
  auto topic = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("help", "Show what a command, a strategy or a part of an experiment does.");
  command->add_option("TOPIC", *topic, "run, ransam, trials, ... (default: the commands)");
  command->callback([topic, &app, &context] { help_on(*topic, app, context.catalog); });
}

}  // namespace glocal::app
