#include "config/overrides.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "config/reader.hpp"
#include "config/yaml_parser.hpp"

namespace glocal {
namespace {

using Path = std::span<const std::string>;

/// Finds out which keys on a path stand for a strategy: there, and only there, the next key takes the place
/// of others.
class StrategyFinder final : public ParamVisitor {
 public:
  /// Fills `is_strategy[i]` for path[i], from `depth` on.
  StrategyFinder(Path path, std::size_t depth, std::vector<bool>& is_strategy)
      : path_(path), depth_(depth), is_strategy_(&is_strategy) {}

  void strategy(std::string_view name, StrategyChoice& /*choice*/, const RegistryBase& registry,
                const FieldInfo& /*info*/) override {
    if (!leads_to(name)) return;
    (*is_strategy_)[depth_] = true;
    const std::size_t below = depth_ + 1;
    const StrategyInfo* info = below < path_.size() ? registry.find(path_[below]) : nullptr;
    if (info == nullptr) return;
    StrategyFinder deeper(path_, below + 1, *is_strategy_);
    info->default_params()->visit(deeper);
  }

 private:
  void plain(std::string_view /*name*/, ValueRef /*value*/, const FieldInfo& /*info*/) override {}

  void group(std::string_view name, AnyParams& params, const FieldInfo& /*info*/) override {
    if (!leads_to(name)) return;
    StrategyFinder deeper(path_, depth_ + 1, *is_strategy_);
    params.visit(deeper);
  }

  void list(std::string_view /*name*/, AnyList& /*list*/, const FieldInfo& /*info*/) override {}

  [[nodiscard]] bool leads_to(std::string_view name) const {
    return depth_ < path_.size() && path_[depth_] == name;
  }

  Path path_;
  std::size_t depth_;
  std::vector<bool>* is_strategy_;
};

/// No experiment is so deep, and a tree that is would be too deep to walk.
constexpr std::size_t most_parts = 32;

/// None if a part is empty.
std::optional<std::vector<std::string>> split(std::string_view path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (const std::string& part : parts) {
    if (part.empty()) return std::nullopt;
  }
  return parts;
}

/// Makes a map of the node, if that loses nothing: of nothing at all, or of a strategy's bare name.
bool make_map(YamlNode& node, const Place& place, bool is_strategy, const std::string& next) {
  if (node.kind == NodeKind::null || node.kind == NodeKind::invalid) {
    node = make_node(NodeKind::map, place);
  } else if (is_strategy && node.kind == NodeKind::scalar) {
    YamlNode map = make_node(NodeKind::map, node.place);
    if (node.text == next) map.entries.push_back({next, node.place, make_node(NodeKind::null, node.place)});
    node = std::move(map);
  }
  return node.kind == NodeKind::map;
}

/// The node below `key`, made if it is not there.
YamlNode& enter(YamlNode& map, const std::string& key, const Place& place) {
  if (YamlEntry* entry = find_entry(map, key)) return entry->value;
  map.entries.push_back({key, place, make_node(NodeKind::null, place)});
  return map.entries.back().value;
}

void put(YamlNode& tree, Path path, const std::vector<bool>& is_strategy, YamlNode value, const Place& place,
         std::vector<Fault>& faults) {
  YamlNode* node = &tree;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool in_strategy = i > 0 && is_strategy[i - 1];
    if (!make_map(*node, place, in_strategy, path[i])) {
      const std::string at = i == 0 ? "the file" : "'" + path[i - 1] + "'";
      add_fault(faults, place, "cannot set '{}': {} is not a map but {}", path[i], at, name_of(*node));
      return;
    }
    if (in_strategy && find_entry(*node, path[i]) == nullptr) node->entries.clear();
    node = &enter(*node, path[i], place);
  }
  *node = std::move(value);
}

}  // namespace

void apply_change(YamlNode& tree, const std::string& path, YamlNode value, const Place& place,
                  AnyParams& params, std::vector<Fault>& faults) {
  const auto parts = split(path);
  if (!parts) {
    add_fault(faults, place, "the path has an empty part; write it as a.b.c");
    return;
  }
  if (parts->size() > most_parts) {
    add_fault(faults, place, "the path has {} parts; no value lies deeper than {}", parts->size(),
              most_parts);
    return;
  }
  std::vector<bool> is_strategy(parts->size(), false);
  StrategyFinder finder(*parts, 0, is_strategy);
  params.visit(finder);
  put(tree, *parts, is_strategy, std::move(value), place, faults);
}

void apply_overrides(YamlNode& tree, const std::vector<Override>& overrides, AnyParams& params,
                     std::vector<Fault>& faults) {
  for (const auto& [text, value] : overrides) {
    const auto origin = std::make_shared<Origin>(
        Origin{fmt::format("--set {}={}", text, value), std::filesystem::current_path()});
    auto node = parse_yaml_value(value, origin, faults);
    if (node) apply_change(tree, text, *std::move(node), {origin, 0, 0}, params, faults);
  }
}

void fill(AnyParams& params, YamlNode tree, const std::vector<Override>& overrides) {
  std::vector<Fault> faults;
  apply_overrides(tree, overrides, params, faults);
  read_params(tree, params, faults);
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

}  // namespace glocal
