// glocal list: which strategies there are.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "config/help.hpp"
#include "config/nearest.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

void list(const std::string& kind, const Catalog& catalog) {
  std::vector<std::string> kinds;
  std::string text;
  for (const RegistryBase* registry : catalog.registries()) {
    kinds.push_back(registry->kind());
    if (kind == registry->kind()) {
      fmt::print("{}", list_strategies(*registry));
      return;
    }
    text += (text.empty() ? "" : "\n") + registry->kind() + "\n" + list_strategies(*registry);
  }
  if (!kind.empty()) {
    throw ConfigError({{"", 0, 0, "unknown kind '" + kind + "'" + suggestion(kind, kinds, "there are")}});
  }
  fmt::print("{}", text);
}

}  // namespace

void add_list(CLI::App& app, Context& context) {
  auto kind = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("list", "List the strategies there are.");
  command->add_option("KIND", *kind, "Only of this kind: matcher, map_source, ...");
  command->callback([kind, &context] { list(*kind, context.catalog); });
}

}  // namespace glocal::app
