// glocal describe: what a strategy, or an experiment file, can be told.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/standard_streams.hpp"
#include "config/help.hpp"
#include "config/nearest.hpp"
#include "config/reader.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

[[noreturn]] void refuse(const std::string& name, const Catalog& catalog) {
  std::vector<std::string> names = {"experiment"};
  for (const RegistryBase* registry : catalog.registries()) {
    for (std::string& other : names_of(*registry)) names.push_back(std::move(other));
  }
  throw ConfigError("", "nothing is called '" + name + "'" + suggestion(name, names, "there are"));
}

void describe_name(const std::string& name, bool as_json, const Catalog& catalog) {
  if (as_json) {
    const auto found = help_json(name, catalog);
    if (!found) refuse(name, catalog);
    answer("{}\n", found->dump(2));
    return;
  }
  const auto text = help(name, catalog);
  if (!text) refuse(name, catalog);
  answer(*text);
}

}  // namespace

void add_describe(CLI::App& app, Context& context) {
  auto name = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "describe", "Show the parameters of a strategy, or the keys of an experiment or of a part of it.");
  command->add_option("NAME", *name, "A strategy of any kind, 'experiment', or a part of one, such as trials")
      ->required();
  command->add_flag("--json", *as_json, "Print it as JSON");
  command->callback([name, as_json, &context] { describe_name(*name, *as_json, context.catalog); });
}

}  // namespace glocal::app
