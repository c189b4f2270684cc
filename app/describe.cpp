// glocal describe: what a strategy, or an experiment file, can be told.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "config/help.hpp"
#include "config/nearest.hpp"
#include "config/reader.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

void describe_name(const std::string& name, const Catalog& catalog) {
  if (const auto text = help(name, catalog)) {
    fmt::print("{}", *text);
    return;
  }
  std::vector<std::string> names = {"experiment"};
  for (const RegistryBase* registry : catalog.registries()) {
    for (std::string& other : names_of(*registry)) names.push_back(std::move(other));
  }
  throw ConfigError({{"", 0, 0, "nothing is called '" + name + "'" + suggestion(name, names, "there are")}});
}

}  // namespace

void add_describe(CLI::App& app, Context& context) {
  auto name = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("describe", "Show the parameters of a strategy, or the keys of an experiment.");
  command->add_option("NAME", *name, "A strategy of any kind, or 'experiment'")->required();
  command->callback([name, &context] { describe_name(*name, context.catalog); });
}

}  // namespace glocal::app
