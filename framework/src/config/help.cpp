#include "config/help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "config/experiment_params.hpp"
#include "config/field_docs.hpp"
#include "config/nearest.hpp"
#include "config/reader.hpp"

namespace glocal {
namespace {

void write_field(const FieldDoc& field, std::size_t indent, std::string& text);

/// The fields for some of the readers.
void write_fields(const StructDoc& doc, bool for_experts, std::size_t indent, std::string& text) {
  for (const FieldDoc& field : doc.fields) {
    if ((field.info.audience == Audience::expert) == for_experts) write_field(field, indent, text);
  }
}

void write_rules(const StructDoc& doc, const std::string& margin, std::string& text) {
  for (const RuleDoc& rule : doc.rules) {
    text += margin + "Rule: " + (rule.field.empty() ? "" : rule.field + " ") + rule.rule + ".\n";
  }
}

void write_field(const FieldDoc& field, std::size_t indent, std::string& text) {
  const std::string margin(indent, ' ');
  std::string facts = type_name(field);
  const std::string allowed = allowed_text(field);
  if (!allowed.empty()) facts += " (" + allowed + ")";
  const std::string value = default_text(field);
  if (!value.empty()) facts += field.info.required ? ", required" : ", default " + value;
  text += fmt::format("{0}{1}: {2}\n{0}    {3}\n", margin, field.name, facts, field.info.doc.text);
  for (const StructDoc& inner : field.inner) {
    write_fields(inner, false, indent + 4, text);
    write_fields(inner, true, indent + 4, text);
    write_rules(inner, margin + "    ", text);
  }
}

/// What to tune first, the fields for everyone, and those for experts behind them.
void write_struct(const StructDoc& doc, std::size_t indent, std::string& text) {
  const std::string margin(indent, ' ');
  const std::vector<std::string> first = to_tune(doc);
  if (!first.empty()) text += margin + "Tune first: " + join(first) + ".\n\n";
  write_fields(doc, false, indent, text);
  std::string for_experts;
  write_fields(doc, true, indent, for_experts);
  if (!for_experts.empty()) text += "\n" + margin + "For experts:\n\n" + for_experts;
  write_rules(doc, margin, text);
}

std::string strategy_help(const StrategyInfo& info, const RegistryBase& registry) {
  std::string text = fmt::format(
      "{} ({}, from {}, {})\n{}\n{}\n", info.name, registry.kind(), info.origin, to_string(info.standing),
      info.doc, info.motions == Motions{} ? "" : fmt::format("Motions: {}.\n", to_string(info.motions)));
  const StructDoc doc = document(*info.default_params());
  if (doc.fields.empty()) return text + "  No parameters.\n";
  write_struct(doc, 2, text);
  return text;
}

using Json = nlohmann::ordered_json;

Json struct_json(const StructDoc& doc);

Json field_json(const FieldDoc& field) {
  const FieldInfo& info = field.info;
  Json json = {{"name", field.name}, {"type", type_name(field)}, {"doc", info.doc.text}};
  if (info.required) json["required"] = true;
  if (!field.default_value.is_null()) json["default"] = field.default_value;
  if (*info.unit != '\0') json["unit"] = info.unit;
  if (std::isfinite(info.min)) json["min"] = info.min;
  if (std::isfinite(info.above)) json["above"] = info.above;
  if (std::isfinite(info.max)) json["max"] = info.max;
  if (!info.choices.empty()) json["choices"] = info.choices;
  if (field.registry != nullptr) json["strategies"] = names_of(*field.registry);
  if (info.audience != Audience::everyone)
    json["audience"] = info.audience == Audience::tuner ? "tuner" : "expert";
  if (!field.inner.empty()) json.update(struct_json(field.inner.front()));
  return json;
}

/// Parameters, and rules that span them.
Json struct_json(const StructDoc& doc) {
  Json fields = Json::array();
  for (const FieldDoc& field : doc.fields) fields.push_back(field_json(field));
  Json json = {{"parameters", std::move(fields)}};
  for (const RuleDoc& rule : doc.rules) json["rules"].push_back({{"about", rule.field}, {"rule", rule.rule}});
  return json;
}

Json strategy_json(const StrategyInfo& info, const RegistryBase& registry) {
  Json motions = Json::array();
  for (const Motion motion : every_motion) {
    if (info.motions.contain(motion)) motions.push_back(to_string(motion));
  }
  return {{"kind", registry.kind()},
          {"name", info.name},
          {"doc", info.doc},
          {"origin", info.origin},
          {"status", info.standing.is_stable ? "stable" : "experimental"},
          {"since", info.standing.since},
          {"motions", std::move(motions)}};
}

/// With its parameters.
Json full_strategy_json(const StrategyInfo& info, const RegistryBase& registry) {
  Json json = strategy_json(info, registry);
  json.update(struct_json(document(*info.default_params())));
  return json;
}

}  // namespace

std::optional<nlohmann::ordered_json> help_json(std::string_view name, const Catalog& catalog) {
  Json found = Json::array();
  ExperimentFileParams experiment(catalog);
  if (name == "experiment") {
    found.push_back({{"name", "experiment"}});
    found.back().update(struct_json(document(experiment)));
  } else if (const auto end = find_path(experiment, name)) {
    found.push_back(end->strategy == nullptr ? field_json(end->field)
                                             : full_strategy_json(*end->strategy, *end->field.registry));
  }
  for (const RegistryBase* registry : catalog.registries()) {
    const StrategyInfo* info = registry->find(name);
    if (info != nullptr) found.push_back(full_strategy_json(*info, *registry));
  }
  return found.empty() ? std::nullopt : std::optional(std::move(found));
}

nlohmann::ordered_json strategies_json(const RegistryBase& registry) {
  Json all = Json::array();
  for (const StrategyInfo* info : registry.all()) all.push_back(strategy_json(*info, registry));
  return all;
}

std::optional<std::string> help(std::string_view name, const Catalog& catalog) {
  std::string text;
  if (name == "experiment") {
    ExperimentFileParams params(catalog);
    text = "experiment\nThe keys of an experiment file.\n\n";
    write_struct(document(params), 2, text);
  } else if (ExperimentFileParams params(catalog); const auto end = find_path(params, name)) {
    if (end->strategy != nullptr) return strategy_help(*end->strategy, *end->field.registry);
    text = "A part of an experiment file.\n\n";
    write_field(end->field, 0, text);
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
  std::size_t standing_width = 0;
  for (const StrategyInfo* info : all) {
    width = std::max(width, info->name.size());
    standing_width = std::max(standing_width, to_string(info->standing).size());
  }
  std::string text;
  for (const StrategyInfo* info : all)
    text += fmt::format("  {:<{}}  {:<{}}  {}\n", info->name, width, to_string(info->standing),
                        standing_width, info->doc);
  return text;
}

}  // namespace glocal
