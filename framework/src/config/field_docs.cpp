#include "config/field_docs.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

#include "config/nearest.hpp"
#include "config/reader.hpp"
#include "config/scalars.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

/// The types of plain fields come first, in the order of ValueRef's.
static_assert(static_cast<std::size_t>(FieldType::group) == std::variant_size_v<ValueRef>);

constexpr std::array type_names = {"true or false",
                                   "whole number",
                                   "whole number",
                                   "number",
                                   "number or auto",
                                   "text",
                                   "path",
                                   "list of numbers",
                                   "list of texts",
                                   "list of paths",
                                   "list of pairs of numbers",
                                   "maps of paths and values",
                                   "map of paths and lists of values",
                                   "map of paths and ranges",
                                   "whole numbers and ranges A..B",
                                   "names, files and maps of keys",
                                   "map",
                                   "list of maps"};
/// What a strategy is called, its registry says.
static_assert(type_names.size() == static_cast<std::size_t>(FieldType::strategy));

template <class T>
Json to_json_value(const T& value) {
  return value;
}
Json to_json_value(const std::optional<double>& value) {
  return value ? Json(*value) : Json("auto");
}
Json to_json_value(const FilePath& value) {
  return value.text;
}
Json to_json_value(const std::vector<FilePath>& values) {
  Json list = Json::array();
  for (const FilePath& value : values) list.push_back(value.text);
  return list;
}

/// There is no default to show.
template <std::derived_from<Written> T>
Json to_json_value(const T& /*value*/) {
  return {};
}

class Documenter final : public ParamVisitor {
 public:
  void strategy(std::string_view name, StrategyChoice& choice, const RegistryBase& registry,
                const FieldInfo& info) override {
    add(name, FieldType::strategy, info, choice.name.empty() ? Json() : Json(choice.name));
    doc_.fields.back().registry = &registry;
  }

  void require(bool /*holds*/, std::string_view field, std::string_view rule) override {
    doc_.rules.push_back({std::string(field), std::string(rule)});
  }

  [[nodiscard]] StructDoc take() { return std::move(doc_); }

 private:
  void plain(std::string_view name, ValueRef value, const FieldInfo& info) override {
    const auto json = [](const auto* v) { return to_json_value(*v); };
    add(name, static_cast<FieldType>(value.index()), info, info.required ? Json() : std::visit(json, value));
  }

  void group(std::string_view name, AnyParams& params, const FieldInfo& info) override {
    add(name, FieldType::group, info, Json());
    doc_.fields.back().inner = {document(params)};
  }

  void list(std::string_view name, AnyList& list, const FieldInfo& info) override {
    Documenter items;
    list.visit_default(items);
    // A list that is not empty by default is too rare to be worth showing.
    add(name, FieldType::list, info, list.size() == 0 && !info.required ? Json::array() : Json());
    doc_.fields.back().inner = {items.take()};
  }

  void add(std::string_view name, FieldType type, const FieldInfo& info, Json default_value) {
    doc_.fields.push_back({std::string(name), type, info, std::move(default_value), {}, nullptr});
  }

  StructDoc doc_;
};

}  // namespace

StructDoc document(AnyParams& params) {
  Documenter documenter;
  params.visit(documenter);
  return documenter.take();
}

std::optional<PathEnd> find_path(AnyParams& params, std::string_view path) {
  const auto take_part = [&] {
    std::string part(path.substr(0, path.find('.')));
    path.remove_prefix(std::min(part.size() + 1, path.size()));
    return part;
  };
  StructDoc doc = document(params);
  while (true) {
    const std::string name = take_part();
    const auto at = std::ranges::find(doc.fields, name, &FieldDoc::name);
    if (at == doc.fields.end()) return std::nullopt;
    const FieldDoc field = *at;
    if (path.empty()) return PathEnd{field};
    if (field.type == FieldType::group) {
      doc = field.inner.front();
      continue;
    }
    const StrategyInfo* info = field.registry == nullptr ? nullptr : field.registry->find(take_part());
    if (info == nullptr) return std::nullopt;
    if (path.empty()) return PathEnd{field, info};
    doc = document(*info->default_params());
  }
}

std::vector<PathPart> parts_after(AnyParams& params, std::string_view path) {
  const auto parts_of = [](const StructDoc& doc) {
    std::vector<PathPart> parts;
    for (const FieldDoc& field : doc.fields) {
      const bool is_group = field.type == FieldType::group;
      parts.push_back({.name = field.name,
                       .doc = field.info.doc.text,
                       .is_followed = is_group || field.registry != nullptr,
                       .has_value = !is_group});
    }
    return parts;
  };
  if (path.empty()) return parts_of(document(params));
  const std::optional<PathEnd> end = find_path(params, path);
  if (!end) return {};
  if (end->strategy != nullptr) return parts_of(document(*end->strategy->default_params()));
  if (end->field.type == FieldType::group) return parts_of(end->field.inner.front());
  std::vector<PathPart> parts;
  if (end->field.registry == nullptr) return parts;
  for (const StrategyInfo* info : end->field.registry->all()) {
    const bool has_fields = !document(*info->default_params()).fields.empty();
    parts.push_back({.name = info->name, .doc = info->doc, .is_followed = has_fields, .has_value = false});
  }
  return parts;
}

std::vector<std::string> to_tune(const StructDoc& doc) {
  std::vector<std::string> names;
  for (const FieldDoc& field : doc.fields) {
    if (field.info.audience == Audience::tuner) names.push_back(field.name);
    for (const StructDoc& inner : field.inner) {
      for (const std::string& name : to_tune(inner)) names.push_back(field.name + "." + name);
    }
  }
  return names;
}

std::string type_name(const FieldDoc& field) {
  if (field.type == FieldType::strategy) return field.registry->kind();
  return type_names[static_cast<std::size_t>(field.type)];
}

std::string default_text(const FieldDoc& field) {
  if (field.info.required) return "required";
  if (field.default_value.is_null()) return "";
  const bool is_word = field.type == FieldType::number_or_auto && field.default_value.is_string();
  if (field.type == FieldType::strategy || is_word) return field.default_value.get<std::string>();
  // Doubles without the ".0" that JSON gives them.
  if (field.default_value.is_number_float()) return to_yaml(field.default_value.get<double>());
  return field.default_value.dump();
}

std::string allowed_text(const FieldDoc& field) {
  if (field.registry != nullptr) return join(names_of(*field.registry));
  if (!field.info.choices.empty()) return join(field.info.choices);
  std::string bounds = bounds_text(field.info);
  const std::string items = count_text(field.info);
  if (field.type == FieldType::unsigned_whole && bounds.empty()) bounds = ">= 0";
  // Without bounds there is still the unit to tell.
  if (bounds.empty() && *field.info.unit != '\0') bounds = field.info.unit;
  return items + (items.empty() || bounds.empty() ? "" : "; each ") + bounds;
}

}  // namespace glocal
