// glocal list: which strategies there are.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/standard_streams.hpp"
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

/// The registry of that kind, or all of them without one.
std::vector<const RegistryBase*> chosen(const std::string& kind, const Catalog& catalog) {
  const auto all = catalog.registries();
  if (kind.empty()) return {all.begin(), all.end()};
  const RegistryBase* registry = registry_of(kind, catalog);
  if (registry == nullptr) throw ConfigError({unknown_kind(kind, catalog)});
  return {registry};
}

void list_as_json(const std::vector<const RegistryBase*>& registries) {
  nlohmann::ordered_json strategies = nlohmann::ordered_json::array();
  for (const RegistryBase* registry : registries) {
    for (auto& strategy : strategies_json(*registry)) strategies.push_back(std::move(strategy));
  }
  answer("{}\n", strategies.dump(2));
}

void list(const std::string& kind, const Catalog& catalog) {
  std::string text;
  for (const RegistryBase* registry : chosen(kind, catalog)) {
    if (kind.empty()) text += (text.empty() ? "" : "\n") + registry->kind() + "\n";
    text += list_strategies(*registry);
  }
  answer(text);
}

}  // namespace

void add_list(CLI::App& app, Context& context) {
  auto kind = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("list", "List the strategies there are.");
  command->add_option("KIND", *kind, "Only of this kind: matcher, map_source, ...");
  command->add_flag("--json", *as_json, "Print them as JSON");
  command->callback([kind, as_json, &context] {
    if (*as_json) {
      list_as_json(chosen(*kind, context.catalog));
    } else {
      list(*kind, context.catalog);
    }
  });
}

}  // namespace glocal::app
