// A description as data: what help, schema and reference are written from.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/params.hpp"
#include "glocal/registry.hpp"

namespace glocal {

/// Those of plain fields are in the order of ValueRef.
enum class FieldType {
  boolean,
  whole,
  unsigned_whole,
  number,
  number_or_auto,
  text,
  path,
  numbers,
  texts,
  paths,
  pairs,
  named_changes,
  listed_changes,
  ranged_changes,
  seeds,
  parts,
  group,
  list,
  strategy
};

struct StructDoc;

struct FieldDoc {
  std::string name;
  FieldType type;
  FieldInfo info;
  nlohmann::ordered_json default_value;    ///< Null if there is none.
  std::vector<StructDoc> inner;            ///< One, of a group or of a list's items; none for other types.
  const RegistryBase* registry = nullptr;  ///< Of a strategy.
};

/// A rule that spans fields.
struct RuleDoc {
  std::string field;  ///< Empty if it is about all of the struct.
  std::string rule;
};

struct StructDoc {
  std::vector<FieldDoc> fields;
  std::vector<RuleDoc> rules;
};

/// The struct's present values are the defaults.
[[nodiscard]] StructDoc document(AnyParams& params);

/// Where a path leads: to a field, or to a strategy that one can have.
struct PathEnd {
  FieldDoc field;
  const StrategyInfo* strategy = nullptr;  ///< Of the field's registry; null if the path ends at the field.
};

/// Of a path such as localizer.matcher.ransam.iterations, with the default of a strategy's parameters; none
/// if it leads nowhere.
[[nodiscard]] std::optional<PathEnd> find_path(AnyParams& params, std::string_view path);

/// What may follow a path, or begin one if it is empty.
struct PathPart {
  std::string name;
  std::string doc;           ///< One sentence.
  bool is_followed = false;  ///< By further parts.
  bool has_value = true;     ///< Which can be set.
};
/// Empty if none may follow, or if the path leads nowhere.
[[nodiscard]] std::vector<PathPart> parts_after(AnyParams& params, std::string_view path);

/// The fields to tune first, by their names; those of a group by their paths.
[[nodiscard]] std::vector<std::string> to_tune(const StructDoc& doc);

/// "whole number", "list of paths" …
[[nodiscard]] std::string type_name(const FieldDoc& field);

/// The default as it would be written in a file; "required" if the file must give it, empty if there is none
/// to write.
[[nodiscard]] std::string default_text(const FieldDoc& field);

/// What values are allowed: bounds, choices, number of items, strategies. Empty if all are.
[[nodiscard]] std::string allowed_text(const FieldDoc& field);

}  // namespace glocal
