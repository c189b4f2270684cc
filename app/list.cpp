// glocal list: which strategies there are, and which methods, cases and suites.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/standard_streams.hpp"
#include "config/builtin_parts.hpp"
#include "config/help.hpp"
#include "config/strategy_names.hpp"
#include "config/suites.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
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

/// "methods", "cases" and "suites"; none for a kind of strategies.
std::optional<PartKind> parts_named(const std::string& kind) {
  if (kind == "methods" || kind == "method") return PartKind::method;
  if (kind == "cases" || kind == "case") return PartKind::the_case;
  if (kind == "suites" || kind == "suite") return PartKind::suite;
  return std::nullopt;
}

void list_parts(PartKind kind, bool as_json) {
  std::vector<BuiltinPart> parts = builtin_parts(kind);
  if (kind == PartKind::suite) {
    for (BuiltinPart& part : parts) part.name = read_suite(part.name).id();
  }
  if (as_json) {
    auto json = nlohmann::ordered_json::array();
    for (const BuiltinPart& part : parts)
      json.push_back({{"name", part.name}, {"about", part.about}, {"file", part.file.string()}});
    return answer("{}\n", json.dump(2));
  }
  std::size_t width = 0;
  for (const BuiltinPart& part : parts) width = std::max(width, part.name.size());
  for (const BuiltinPart& part : parts) answer("{:<{}}  {}\n", part.name, width, part.about);
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
  CLI::App* command = app.add_subcommand("list", "List the strategies, methods, cases or suites there are.");
  command->add_option("KIND", *kind,
                      "methods, cases, suites, or strategies of one kind: matcher, map_source, ...");
  command->add_flag("--json", *as_json, "Print them as JSON");
  command->callback([kind, as_json, &context] {
    if (const auto parts = parts_named(*kind)) {
      list_parts(*parts, *as_json);
    } else if (*as_json) {
      list_as_json(chosen(*kind, context.catalog));
    } else {
      list(*kind, context.catalog);
    }
  });
}

}  // namespace glocal::app
