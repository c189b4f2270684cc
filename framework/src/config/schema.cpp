#include "config/schema.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "config/experiment_params.hpp"
#include "config/field_docs.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

Json struct_schema(const StructDoc& doc);

/// Bounds of 1 rather than 1.0 where they are whole, as a reader expects.
Json bound(double value) {
  constexpr double exact = 9007199254740992.0;  // 2^53
  const bool whole = std::trunc(value) == value && std::abs(value) <= exact;
  return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json number_schema(const char* type, const FieldInfo& info) {
  Json schema = {{"type", type}};
  if (std::isfinite(info.min)) schema["minimum"] = bound(info.min);
  if (std::isfinite(info.above)) schema["exclusiveMinimum"] = bound(info.above);
  if (std::isfinite(info.max)) schema["maximum"] = bound(info.max);
  return schema;
}

Json whole_schema(const FieldInfo& info, double smallest, double largest) {
  FieldInfo limited = info;
  limited.min = std::max(info.min, smallest);
  limited.max = std::min(info.max, largest);
  return number_schema("integer", limited);
}

Json text_schema(const FieldInfo& info) {
  Json schema = {{"type", "string"}};
  if (!info.choices.empty()) schema["enum"] = info.choices;
  return schema;
}

Json list_schema(Json items, const FieldInfo& info) {
  Json schema = {{"type", "array"}, {"items", std::move(items)}};
  if (info.min_items > 0) schema["minItems"] = info.min_items;
  if (info.max_items != std::numeric_limits<std::size_t>::max()) schema["maxItems"] = info.max_items;
  return schema;
}

Json pair_schema(const FieldInfo& info) {
  return {{"type", "array"}, {"items", number_schema("number", info)}, {"minItems", 2}, {"maxItems", 2}};
}

/// A map of any keys; nothing at all is one without keys.
Json map_schema(Json values) {
  return {{"type", {"object", "null"}}, {"additionalProperties", std::move(values)}};
}

/// What a number is drawn from, or any value.
Json range_schema() {
  const Json number = {{"type", "number"}};
  return {{"anyOf",
           {{{"type", "array"}, {"items", number}, {"minItems", 2}, {"maxItems", 2}},
            {{"type", "object"},
             {"properties", {{"from", number}, {"to", number}, {"scale", {{"enum", {"linear", "log"}}}}}},
             {"required", {"from", "to"}},
             {"additionalProperties", false}},
            {{"type", "object"},
             {"properties", {{"choices", {{"type", "array"}, {"minItems", 1}}}}},
             {"required", {"choices"}},
             {"additionalProperties", false}}}}};
}

/// A seed or a range of them, or a list of both.
Json seeds_schema() {
  const Json one = {
      {"anyOf",
       {{{"type", "integer"}, {"minimum", 0}}, {{"type", "string"}, {"pattern", "^[0-9]+\\.\\.[0-9]+$"}}}}};
  return {{"anyOf", {one, {{"type", "array"}, {"items", one}}, {{"type", "null"}}}}};
}

/// Names, files and maps of keys.
Json parts_schema() {
  const Json name = {{"type", "string"}};
  const Json named = {{"type", "object"}, {"additionalProperties", {{"type", {"object", "string", "null"}}}}};
  return {{"anyOf",
           {name, named, {{"type", "array"}, {"items", {{"anyOf", {name, named}}}}}, {{"type", "null"}}}}};
}

Json type_schema(const FieldDoc& field) {
  const FieldInfo& info = field.info;
  switch (field.type) {
    case FieldType::boolean:
      return {{"type", "boolean"}};
    case FieldType::whole:
      return whole_schema(info, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    case FieldType::unsigned_whole:
      return whole_schema(info, 0.0, std::numeric_limits<double>::infinity());
    case FieldType::number:
      return number_schema("number", info);
    case FieldType::number_or_auto:
      return {{"anyOf", {number_schema("number", info), {{"const", "auto"}}}}};
    case FieldType::text:
      return text_schema(info);
    case FieldType::path:
      return {{"type", "string"}};
    case FieldType::numbers:
      return list_schema(number_schema("number", info), info);
    case FieldType::texts:
      return list_schema(text_schema(info), info);
    case FieldType::paths:
      return list_schema({{"type", "string"}}, info);
    case FieldType::pairs:
      return list_schema(pair_schema(info), info);
    case FieldType::named_changes:
      return map_schema(map_schema(true));
    case FieldType::listed_changes:
      return map_schema({{"type", "array"}, {"minItems", 1}});
    case FieldType::ranged_changes:
      return map_schema(range_schema());
    case FieldType::seeds:
      return seeds_schema();
    case FieldType::parts:
      return parts_schema();
    case FieldType::group:
      return struct_schema(field.inner.front());
    case FieldType::list:
      return list_schema(struct_schema(field.inner.front()), info);
    case FieldType::strategy:
      return {{"$ref", "#/$defs/" + field.registry->kind()}};
  }
  return true;
}

Json field_schema(const FieldDoc& field) {
  Json schema = type_schema(field);
  const std::string unit = *field.info.unit == '\0' ? "" : " [" + std::string(field.info.unit) + "]";
  schema["description"] = field.info.doc.text + unit;
  if (!field.default_value.is_null()) schema["default"] = field.default_value;
  return schema;
}

bool has_required(const StructDoc& doc) {
  for (const FieldDoc& field : doc.fields) {
    if (field.info.required) return true;
    // A map left out must not leave out what it has to give.
    if (field.type == FieldType::group && has_required(field.inner.front())) return true;
  }
  return false;
}

Json struct_schema(const StructDoc& doc) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const FieldDoc& field : doc.fields) {
    properties[field.name] = field_schema(field);
    const bool must =
        field.info.required || (field.type == FieldType::group && has_required(field.inner.front()));
    if (must) required.push_back(field.name);
  }
  Json schema = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  // Nothing at all is a map without keys.
  if (required.empty()) {
    schema["type"] = Json::array({"object", "null"});
  } else {
    schema["required"] = std::move(required);
  }
  return schema;
}

/// One strategy: its bare name if it can do without parameters, or a map of its name and them.
void add_forms(const StrategyInfo& info, Json& forms) {
  const StructDoc doc = document(*info.default_params());
  if (!has_required(doc)) forms.push_back({{"const", info.name}, {"description", info.doc}});
  forms.push_back({{"type", "object"},
                   {"description", info.doc},
                   {"properties", {{info.name, struct_schema(doc)}}},
                   {"required", {info.name}},
                   {"additionalProperties", false}});
}

/// What a strategy of one kind may be; of a kind without any, nothing.
Json registry_schema(const RegistryBase& registry) {
  Json forms = Json::array();
  for (const StrategyInfo* info : registry.all()) add_forms(*info, forms);
  return forms.empty() ? Json{{"not", Json::object()}} : Json{{"oneOf", std::move(forms)}};
}

}  // namespace

Json experiment_schema(const Catalog& catalog) {
  ExperimentFileParams params(catalog);
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "glocal experiment"}};
  schema.update(struct_schema(document(params)));
  for (const RegistryBase* registry : catalog.registries()) {
    schema["$defs"][registry->kind()] = registry_schema(*registry);
  }
  return schema;
}

}  // namespace glocal
