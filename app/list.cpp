// glocal list: which strategies there are.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "config/help.hpp"
#include "config/nearest.hpp"
#include "glocal/error.hpp"

namespace glocal::app {

const RegistryBase* registry_of(const std::string& kind, const Catalog& catalog) {
  const auto all = catalog.registries();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto* r) { return r->kind() == kind; });
  return found == all.end() ? nullptr : *found;
}

Fault unknown_kind(const std::string& kind, const Catalog& catalog) {
  std::vector<std::string> kinds;
  for (const RegistryBase* registry : catalog.registries()) kinds.push_back(registry->kind());
  return {"", 0, 0, "unknown kind '" + kind + "'" + suggestion(kind, kinds, "there are")};
}

namespace {

void list(const std::string& kind, const Catalog& catalog) {
  if (!kind.empty()) {
    const RegistryBase* registry = registry_of(kind, catalog);
    if (registry == nullptr) throw ConfigError({unknown_kind(kind, catalog)});
    fmt::print("{}", list_strategies(*registry));
    return;
  }
  std::string text;
  for (const RegistryBase* registry : catalog.registries()) {
    text += (text.empty() ? "" : "\n") + registry->kind() + "\n" + list_strategies(*registry);
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
