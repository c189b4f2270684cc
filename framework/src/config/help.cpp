#include "config/help.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/experiment_params.hpp"
#include "config/field_docs.hpp"

namespace glocal {
namespace {

void write_struct(const StructDoc& doc, std::size_t indent, std::string& text) {
  const std::string margin(indent, ' ');
  for (const FieldDoc& field : doc.fields) {
    std::string facts = type_name(field);
    const std::string allowed = allowed_text(field);
    if (!allowed.empty()) facts += " (" + allowed + ")";
    const std::string value = default_text(field);
    if (!value.empty()) facts += field.info.required ? ", required" : ", default " + value;
    text += fmt::format("{0}{1}: {2}\n{0}    {3}\n", margin, field.name, facts, field.info.doc.text);
    for (const StructDoc& inner : field.inner) write_struct(inner, indent + 4, text);
  }
  for (const RuleDoc& rule : doc.rules) {
    text += margin + "Rule: " + (rule.field.empty() ? "" : rule.field + " ") + rule.rule + ".\n";
  }
}

std::string strategy_help(const StrategyInfo& info, const RegistryBase& registry) {
  std::string text =
      fmt::format("{} ({}, from {})\n{}\n\n", info.name, registry.kind(), info.origin, info.doc);
  const StructDoc doc = document(*info.default_params());
  if (doc.fields.empty()) return text + "  No parameters.\n";
  write_struct(doc, 2, text);
  return text;
}

}  // namespace

std::optional<std::string> help(std::string_view name, const Catalog& catalog) {
  std::string text;
  if (name == "experiment") {
    ExperimentFileParams params(catalog);
    text = "experiment\nThe keys of an experiment file.\n\n";
    write_struct(document(params), 2, text);
  }
  for (const RegistryBase* registry : catalog.registries()) {
    const StrategyInfo* info = registry->find(name);
    if (info != nullptr) text += (text.empty() ? "" : "\n") + strategy_help(*info, *registry);
  }
  return text.empty() ? std::nullopt : std::optional(text);
}

std::string list_strategies(const RegistryBase& registry) {
  const auto all = registry.all();
  std::size_t width = 0;
  for (const StrategyInfo* info : all) width = std::max(width, info->name.size());
  std::string text;
  for (const StrategyInfo* info : all) text += fmt::format("  {:<{}}  {}\n", info->name, width, info->doc);
  return text;
}

}  // namespace glocal
