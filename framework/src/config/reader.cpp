#include "config/reader.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "config/builtin_parts.hpp"
#include "config/nearest.hpp"
#include "config/scalars.hpp"
#include "config/text_file.hpp"
#include "config/yaml_parser.hpp"

namespace glocal {
namespace {

std::string joined(const std::string& path, std::string_view name) {
  return (path.empty() ? "" : path + ".") + std::string(name);
}

std::string about(const std::string& path, const std::string& message) {
  return path.empty() ? message : path + ": " + message;
}

Fault fault_about(const std::string& path, const Place& place, const std::string& message) {
  Fault fault = fault_at(place, about(path, message));
  fault.path = path;
  return fault;
}

void read_struct(const YamlNode& node, const std::string& path, AnyParams& params, std::vector<Fault>& faults,
                 OtherKeys other_keys);

/// Reads the fields of one struct from one map.
class MapReader final : public ParamVisitor {
 public:
  /// `path` is the map's, for messages.
  MapReader(const YamlNode& map, std::string path, std::vector<Fault>& faults, OtherKeys other_keys)
      : map_(&map), path_(std::move(path)), faults_(&faults), other_keys_(other_keys) {}

  void strategy(std::string_view name, StrategyChoice& choice, const RegistryBase& registry,
                const FieldInfo& info) override {
    const YamlNode* node = take(name, info);
    if (node != nullptr) {
      read_strategy(*node, name, choice, registry);
    } else if (!choice.params && registry.find(choice.name) != nullptr) {
      choice = registry.choose(choice.name);
    } else if (!choice.params && !given(name) && !info.required) {
      refuse(map_->place, std::string(name),
             "the default " + registry.kind() + " '" + choice.name + "' does not exist; name another" +
                 others(registry));
    }
  }

  void require(bool holds, std::string_view field, std::string_view rule) override {
    // What was refused still has its default, about which no rule says anything.
    if (holds || !is_read_) return;
    const YamlEntry* entry = find_entry(*map_, field);
    refuse(entry == nullptr ? map_->place : entry->value.place, std::string(field), std::string(rule));
  }

  void removed(std::string_view name, std::string_view advice) override {
    gone_[std::string(name)] = "was removed: " + std::string(advice);
  }

  /// To be called after all fields were visited.
  void report_unknown_keys() {
    if (other_keys_ == OtherKeys::passed_over) return;
    constexpr std::size_t most = 20;
    std::size_t unknown = 0;
    for (const YamlEntry& entry : map_->entries) {
      if (std::ranges::find(known_, entry.key) != known_.end() || ++unknown > most) continue;
      const std::string key = "key '" + entry.key + "'";
      const auto gone = gone_.find(entry.key);
      const std::string fault = gone != gone_.end() ? key + " " + gone->second
                                : known_.empty()
                                    ? "unknown " + key + " (there are no parameters)"
                                    : "unknown " + key + suggestion(entry.key, known_, "known keys");
      add_fault(entry.place, fault);
    }
    if (unknown > most)
      add_fault(map_->entries.back().place, std::to_string(unknown - most) + " more unknown keys follow");
  }

 private:
  void plain(std::string_view name, ValueRef value, const FieldInfo& info) override {
    const YamlNode* node = take(name, info);
    if (node == nullptr) return;
    const std::size_t before = faults_->size();
    std::visit([&](auto* v) { read(*node, std::string(name), *v, info); }, value);
    is_read_ = is_read_ && faults_->size() == before;
  }

  void group(std::string_view name, AnyParams& params, const FieldInfo& info) override {
    if (const YamlNode* node = take(name, info)) {
      read_struct(*node, joined(path_, name), params, *faults_, other_keys_);
    } else if (!given(name) && !info.required) {
      // Left out, which is wrong only if it has something that must be given.
      read_struct(make_node(NodeKind::null, map_->place), joined(path_, name), params, *faults_, other_keys_);
    }
  }

  void list(std::string_view name, AnyList& list, const FieldInfo& info) override {
    const YamlNode* node = take(name, info);
    if (node == nullptr || !check_list(*node, std::string(name), info, "a list of maps")) return;
    list.resize(0);
    list.resize(node->items.size());
    for (std::size_t i = 0; i < node->items.size(); ++i) {
      const std::string path = joined(path_, name) + "[" + std::to_string(i) + "]";
      DescribedBy item([&list, i](ParamVisitor& visitor) { list.visit(i, visitor); });
      read_struct(node->items[i], path, item, *faults_, other_keys_);
    }
  }

  [[nodiscard]] bool given(std::string_view name) const { return find_entry(*map_, name) != nullptr; }

  /// The field's node if there is one to read; notes that the field is known, and reports it missing if it
  /// must be given.
  const YamlNode* take(std::string_view name, const FieldInfo& info) {
    known_.emplace_back(name);
    note_former_name(name, info);
    const YamlEntry* entry = find_entry(*map_, name);
    if (entry != nullptr && entry->value.kind != NodeKind::invalid) return &entry->value;
    is_read_ = is_read_ && entry == nullptr && !info.required;
    if (entry == nullptr && info.required)
      add_fault(map_->place, "missing key '" + std::string(name) + "': " + std::string(info.doc.text));
    return nullptr;
  }

  void note_former_name(std::string_view name, const FieldInfo& info) {
    const std::string_view formerly = info.formerly;
    if (formerly.empty()) return;
    // What was in radians is in degrees now.
    const bool is_turned = name.ends_with("_deg") && !formerly.ends_with("_deg");
    gone_[std::string(formerly)] =
        "is called '" + std::string(name) + "' now" + (is_turned ? ", and is in degrees" : "");
  }

  void refuse(const Place& place, const std::string& what, const std::string& message) {
    add_fault(place, about(what, message));
  }

  void add_fault(const Place& place, const std::string& message) {
    faults_->push_back(fault_about(path_, place, message));
  }

  template <class T>
  void read(const YamlNode& node, const std::string& what, T& v, const FieldInfo& info) {
    if (node.kind == NodeKind::invalid) return;
    if (auto refusal = take_value(node, info, v)) refuse(node.place, what, *refusal);
  }

  template <class T>
  void read(const YamlNode& node, const std::string& what, std::vector<T>& v, const FieldInfo& info) {
    if (!check_list(node, what, info, "a list")) return;
    v.assign(node.items.size(), T{});
    for (std::size_t i = 0; i < v.size(); ++i) {
      read(node.items[i], what + "[" + std::to_string(i) + "]", v[i], info);
    }
  }

  void read(const YamlNode& node, const std::string& what, std::array<double, 2>& v, const FieldInfo& info) {
    if (node.kind == NodeKind::invalid) return;
    if (node.kind != NodeKind::list || node.items.size() != 2) {
      const std::string got = node.kind == NodeKind::list ? counted(node.items.size()) : name_of(node);
      refuse(node.place, what, "expected a pair of numbers [a, b], got " + got);
      return;
    }
    for (std::size_t i = 0; i < 2; ++i) read(node.items[i], what + "[" + std::to_string(i) + "]", v[i], info);
  }

  void read(const YamlNode& node, const std::string& what, NamedChanges& v, const FieldInfo& /*info*/) {
    if (!check_map(node, what, "a map (name: {path: value})")) return;
    bool good = true;
    for (const YamlEntry& entry : node.entries) {
      good &= check_map(entry.value, what + "." + entry.key, "a map (path: value)");
    }
    if (good) v.written = std::make_shared<const YamlNode>(node);
  }

  void read(const YamlNode& node, const std::string& what, ListedChanges& v, const FieldInfo& /*info*/) {
    if (!check_map(node, what, "a map (path: [value, value])")) return;
    bool good = true;
    for (const YamlEntry& entry : node.entries) {
      good &=
          check_list(entry.value, what + "." + entry.key, {.doc = "", .min_items = 1}, "a list of values");
    }
    if (good) v.written = std::make_shared<const YamlNode>(node);
  }

  void read(const YamlNode& node, const std::string& what, RangedChanges& v, const FieldInfo& /*info*/) {
    if (check_map(node, what, "a map (path: [from, to])")) v.written = std::make_shared<const YamlNode>(node);
  }

  void read(const YamlNode& node, const std::string& /*what*/, SeedList& v, const FieldInfo& /*info*/) {
    v.written = std::make_shared<const YamlNode>(node);
  }

  /// Whoever reads an experiment has taken them out before.
  void read(const YamlNode& /*node*/, const std::string& /*what*/, PartList& /*v*/,
            const FieldInfo& /*info*/) {}

  /// A null node is a map without keys.
  bool check_map(const YamlNode& node, const std::string& what, const std::string& expected) {
    if (node.kind == NodeKind::map || node.kind == NodeKind::null) return true;
    if (node.kind != NodeKind::invalid) {
      refuse(node.place, what, "expected " + expected + ", got " + name_of(node));
    }
    return false;
  }

  bool check_list(const YamlNode& node, const std::string& what, const FieldInfo& info,
                  const std::string& expected) {
    if (node.kind == NodeKind::invalid) return false;
    if (node.kind != NodeKind::list) {
      refuse(node.place, what, "expected " + expected + ", got " + name_of(node));
      return false;
    }
    const std::size_t n = node.items.size();
    if (n >= info.min_items && n <= info.max_items) return true;
    refuse(node.place, what, "expected " + count_text(info) + ", got " + std::to_string(n));
    return false;
  }

  void read_strategy(const YamlNode& node, std::string_view name, StrategyChoice& choice,
                     const RegistryBase& registry) {
    const bool is_map = node.kind == NodeKind::map && node.entries.size() == 1;
    if (node.kind != NodeKind::scalar && !is_map) {
      const std::string got = node.kind == NodeKind::map
                                  ? "a map with " + std::to_string(node.entries.size()) + " keys"
                                  : name_of(node);
      refuse(node.place, std::string(name),
             "expected one " + registry.kind() + ", its name or `name: {parameters}`, got " + got +
                 others(registry));
      return;
    }
    const std::string& chosen = is_map ? node.entries.front().key : node.text;
    if (const std::string* now = registry.renamed(chosen)) {
      refuse(is_map ? node.entries.front().place : node.place, std::string(name),
             "the " + registry.kind() + " '" + chosen + "' is called '" + *now + "' now");
      return;
    }
    if (registry.find(chosen) == nullptr) {
      const auto near = nearest(chosen, names_of(registry));
      const std::string method = find_builtin_part(PartKind::method, chosen)
                                     ? "; '" + chosen + "' is a method: --method " + chosen
                                     : "";
      refuse(is_map ? node.entries.front().place : node.place, std::string(name),
             "unknown " + registry.kind() + " '" + chosen + "'" +
                 (near ? ", did you mean '" + *near + "'?" : "") + others(registry) + method);
      return;
    }
    choice = registry.choose(chosen);
    const YamlNode defaults = make_node(NodeKind::null, node.place);
    read_struct(is_map ? node.entries.front().value : defaults, joined(joined(path_, name), chosen),
                *choice.params, *faults_, other_keys_);
  }

  /// " (there are: a, b)".
  static std::string others(const RegistryBase& registry) {
    const auto names = names_of(registry);
    return names.empty() ? " (none is registered)" : " (there are: " + join(names) + ")";
  }

  const YamlNode* map_;
  std::string path_;
  std::vector<Fault>* faults_;
  OtherKeys other_keys_;
  std::vector<std::string> known_;
  std::map<std::string, std::string> gone_;  ///< What became of keys of earlier versions.
  bool is_read_ = true;                      ///< Whether all values so far are what is written.
};

/// A null node is a map without keys: everything has its default.
void read_struct(const YamlNode& node, const std::string& path, AnyParams& params, std::vector<Fault>& faults,
                 OtherKeys other_keys) {
  if (node.kind == NodeKind::invalid) return;
  if (node.kind != NodeKind::map && node.kind != NodeKind::null) {
    faults.push_back(fault_about(path, node.place, "expected a map (key: value), got " + name_of(node)));
    return;
  }
  MapReader reader(node, path, faults, other_keys);
  params.visit(reader);
  reader.report_unknown_keys();
}

}  // namespace

std::shared_ptr<const Origin> origin_of(const std::filesystem::path& file) {
  return std::make_shared<Origin>(Origin{file.string(), std::filesystem::absolute(file).parent_path()});
}

void read_params(const YamlNode& node, AnyParams& params, std::vector<Fault>& faults, OtherKeys other_keys) {
  read_struct(node, "", params, faults, other_keys);
}

std::vector<std::string> names_of(const RegistryBase& registry) {
  std::vector<std::string> names;
  for (const StrategyInfo* info : registry.all()) names.push_back(info->name);
  return names;
}

void read_yaml(const std::filesystem::path& file, AnyParams& params, OtherKeys other_keys) {
  std::vector<Fault> faults;
  if (const auto tree = parse_yaml(read_text_file(file), origin_of(file), faults))
    read_params(*tree, params, faults, other_keys);
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

}  // namespace glocal
