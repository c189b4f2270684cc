// A YAML document as a small tree in which everything knows where it was written.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "glocal/error.hpp"

namespace glocal {

/// Where text comes from.
struct Origin {
  std::string label;             ///< How faults name it: the file as given, or `--set path=value`.
  std::filesystem::path folder;  ///< What relative paths in it start from.
};

struct Place {
  std::shared_ptr<const Origin> origin;
  int line = 0;    ///< From 1; 0 if there is none.
  int column = 0;  ///< From 1; 0 if there is none.
};

enum class NodeKind {
  null,
  scalar,
  list,
  map,
  invalid,  ///< Already reported as a fault; readers pass over it.
};

struct YamlEntry;

struct YamlNode {
  NodeKind kind = NodeKind::null;
  Place place;
  std::string text;                ///< Of a scalar.
  bool quoted = false;             ///< A quoted or block scalar, which is text whatever it looks like.
  std::vector<YamlNode> items;     ///< Of a list.
  std::vector<YamlEntry> entries;  ///< Of a map, in the order of the file; keys are unique.
};

struct YamlEntry {
  std::string key;
  Place place;  ///< Of the key.
  YamlNode value;
};

[[nodiscard]] inline YamlNode make_node(NodeKind kind, Place place) {
  YamlNode node;
  node.kind = kind;
  node.place = std::move(place);
  return node;
}

[[nodiscard]] inline YamlNode make_scalar(Place place, std::string text) {
  YamlNode node = make_node(NodeKind::scalar, std::move(place));
  node.text = std::move(text);
  return node;
}

/// Null if the map has no such key.
template <class MapNode>
[[nodiscard]] auto* find_entry(MapNode& map, std::string_view key) {
  for (auto& entry : map.entries) {
    if (entry.key == key) return &entry;
  }
  return static_cast<decltype(&map.entries.front())>(nullptr);
}

[[nodiscard]] inline Fault fault_at(const Place& place, std::string message) {
  return {place.origin->label, place.line, place.column, std::move(message)};
}

/// Adds a fault to a list or a set of them, with a message as fmt::format() makes it.
template <class Faults, class... Values>
void add_fault(Faults& faults, const Place& place, fmt::format_string<const Values&...> message,
               const Values&... values) {
  faults.insert(faults.end(), fault_at(place, fmt::format(message, values...)));
}

/// The node and all below it.
[[nodiscard]] std::size_t count_nodes(const YamlNode& node);

/// What a message calls it: "nothing", "'text'", "a list", "a map".
[[nodiscard]] std::string name_of(const YamlNode& node);

}  // namespace glocal
