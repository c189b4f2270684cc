#include "config/strategy_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "config/nearest.hpp"
#include "config/overrides.hpp"
#include "config/reader.hpp"

namespace glocal {

const RegistryBase* registry_of(const std::string& kind, const Catalog& catalog) {
  const auto all = catalog.registries();
  const auto found = std::ranges::find_if(all, [&](const auto* r) { return r->kind() == kind; });
  return found == all.end() ? nullptr : *found;
}

Fault unknown_kind(const std::string& kind, const Catalog& catalog) {
  std::vector<std::string> kinds;
  for (const RegistryBase* registry : catalog.registries()) kinds.push_back(registry->kind());
  return {"", 0, 0, "unknown kind '" + kind + "'" + suggestion(kind, kinds, "there are")};
}

StrategyChoice chosen_strategy(const std::string& kind, const std::string& name,
                               const std::vector<Override>& overrides, const Catalog& catalog) {
  const RegistryBase* registry = registry_of(kind, catalog);
  if (registry == nullptr) throw ConfigError({unknown_kind(kind, catalog)});
  if (registry->find(name) == nullptr)
    throw ConfigError("", fmt::format("there is no {} '{}'{}", kind, name,
                                      suggestion(name, names_of(*registry), "there are")));
  StrategyChoice choice = registry->choose(name);
  const auto origin = std::make_shared<Origin>(Origin{name, std::filesystem::current_path()});
  fill(*choice.params, make_node(NodeKind::null, {origin}), overrides);
  return choice;
}

}  // namespace glocal
