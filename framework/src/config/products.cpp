#include "config/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>

#include "config/builtin_parts.hpp"
#include "config/disturbed_cases.hpp"
#include "config/nearest.hpp"
#include "config/overrides.hpp"
#include "config/reader.hpp"
#include "config/scalars.hpp"
#include "config/text_file.hpp"
#include "config/variants.hpp"
#include "config/writer.hpp"
#include "config/yaml_parser.hpp"
#include "glocal/words.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> of_methods = {"localizer", "plugins"};
constexpr std::array<std::string_view, 4> of_cases = {"map", "observations", "trials", "evaluation"};

template <class Keys>
bool has(const Keys& keys, std::string_view key) {
  return std::ranges::find(keys, key) != keys.end();
}

bool is_key_of(PartKind kind, std::string_view key) {
  return kind == PartKind::method ? has(of_methods, key) : has(of_cases, key);
}

/// Whether text names a file, and not what is built in.
bool is_file_name(std::string_view text) {
  return text.ends_with(".yaml") || text.ends_with(".yml") || text.find('/') != std::string_view::npos;
}

std::vector<std::string> names_of(PartKind kind) {
  std::vector<std::string> names;
  for (const BuiltinPart& part : builtin_parts(kind)) names.push_back(part.name);
  return names;
}

constexpr const char* extends_key = "extends";

/// What a part lacks may stand in the experiment itself.
void check_keys(PartKind kind, const std::string& name, const YamlNode& part, const YamlNode& experiment,
                std::vector<Fault>& faults) {
  const PartKind other = kind == PartKind::method ? PartKind::the_case : PartKind::method;
  const std::string keys =
      kind == PartKind::method ? "localizer and plugins" : "map, observations, trials and evaluation";
  for (const YamlEntry& entry : part.entries) {
    if (is_key_of(kind, entry.key) || entry.key == extends_key) continue;
    const std::string why = is_key_of(other, entry.key)
                                ? fmt::format("'{}' belongs into a {}", entry.key, to_string(other))
                                : fmt::format("unknown key '{}'", shown(entry.key));
    add_fault(faults, entry.place, "{0} {1}: {2}; a {0} has {3}", to_string(kind), shown(name), why, keys);
  }
  if (find_entry(part, extends_key) != nullptr) return;
  const auto require = [&](const char* key) {
    if (find_entry(part, key) == nullptr && find_entry(experiment, key) == nullptr)
      add_fault(faults, part.place, "{} {}: missing key '{}'", to_string(kind), shown(name), key);
  };
  if (kind == PartKind::method) return require("localizer");
  for (const char* key : {"map", "observations", "trials"}) require(key);
}

/// The name of what is given without one: that of the file, without its ending.
std::string own_name(const std::string& text) {
  return is_file_name(text) ? fs::path(text).stem().string() : text;
}

/// Takes a key out of the tree; none if it is not there.
std::optional<YamlNode> take(YamlNode& tree, std::string_view key) {
  const auto found = std::ranges::find(tree.entries, key, &YamlEntry::key);
  if (found == tree.entries.end()) return std::nullopt;
  YamlNode value = std::move(found->value);
  tree.entries.erase(found);
  return value;
}

/// Puts each value of an entry where it stands in there into the tree.
void overlay(YamlNode& tree, const std::string& path, const YamlEntry& entry, AnyParams& params,
             std::vector<Fault>& faults) {
  if (entry.value.kind != NodeKind::map || entry.value.entries.empty()) {
    apply_change(tree, path, entry.value, entry.place, params, faults);
    return;
  }
  for (const YamlEntry& below : entry.value.entries)
    overlay(tree, path + "." + below.key, below, params, faults);
}

/// Where trials start is said in one way: a new one takes the place of the one before.
void drop_starts(YamlNode& trials, const YamlNode& own) {
  constexpr std::array<std::string_view, 4> ways = {"every_m", "starts_m", "every_scan", "whole"};
  const auto is_way = [&](const YamlEntry& entry) { return has(ways, entry.key); };
  if (std::ranges::any_of(own.entries, is_way)) std::erase_if(trials.entries, is_way);
}

/// Puts the values of `own` over those of `tree`; plugins are added to those that are there.
void lay_over(YamlNode& tree, const YamlNode& own, AnyParams& params, std::vector<Fault>& faults) {
  for (const YamlEntry& entry : own.entries) {
    YamlEntry* there = find_entry(tree, entry.key);
    if (there == nullptr) {
      tree.entries.push_back(entry);
    } else if (entry.key == "plugins" && entry.value.kind == NodeKind::list) {
      const auto& more = entry.value.items;
      there->value.items.insert(there->value.items.end(), more.begin(), more.end());
    } else {
      if (entry.key == "trials") drop_starts(there->value, entry.value);
      overlay(tree, entry.key, entry, params, faults);
    }
  }
}

/// Reads parts of an experiment.
class PartReader {
 public:
  /// Of this experiment.
  PartReader(const YamlNode& experiment, AnyParams& params, std::vector<Fault>& faults)
      : experiment_(experiment), params_(params), faults_(faults) {}

  [[nodiscard]] YamlNode read(PartKind kind, const std::string& name, const YamlNode& value, int depth = 0) {
    YamlNode part = value.kind == NodeKind::null ? make_scalar(value.place, name) : value;
    if (part.kind == NodeKind::scalar) part = from_file(kind, part);
    if (part.kind == NodeKind::invalid) return part;
    if (part.kind != NodeKind::map)
      return refuse(part.place, "{} {}: expected a map, a file or a name, got {}", to_string(kind),
                    shown(name), name_of(part));
    check_keys(kind, name, part, experiment_, faults_);
    const auto base = take(part, extends_key);
    if (!base) return part;
    constexpr int deepest = 8;
    if (depth >= deepest)
      return refuse(base->place,
                    "{} {}: extends another one, and that another one, {} times; does one extend itself?",
                    to_string(kind), shown(name), deepest);
    YamlNode tree = read(kind, base->text, *base, depth + 1);
    if (tree.kind == NodeKind::map) lay_over(tree, part, params_, faults_);
    return tree;
  }

  /// Of a list of names, files and `name: {keys}`, or a map of these.
  void add_all(PartKind kind, const std::string& key, const YamlNode& written, CaseRole role,
               std::vector<ExperimentPart>& parts) {
    if (written.kind == NodeKind::map) {
      for (const YamlEntry& entry : written.entries) add(kind, entry, role, parts);
      return;
    }
    const std::vector<YamlNode> one = {written};
    for (const YamlNode& item : written.kind == NodeKind::list ? written.items : one) {
      if (item.kind == NodeKind::scalar) {
        add(kind, {own_name(item.text), item.place, item}, role, parts);
        if (written.kind == NodeKind::scalar && !parts.empty()) parts.back().is_fixed = true;
      } else if (item.kind == NodeKind::map && item.entries.size() == 1) {
        add(kind, item.entries.front(), role, parts);
      } else if (item.kind != NodeKind::invalid) {
        add_fault(faults_, item.place, "{}: expected the name of a {}, its file or `name: {{keys}}`, got {}",
                  key, to_string(kind), name_of(item));
      }
    }
  }

 private:
  void add(PartKind kind, const YamlEntry& entry, CaseRole role, std::vector<ExperimentPart>& parts) {
    const std::string& name = entry.key;
    const auto is_same = [&](const ExperimentPart& part) { return part.name == name; };
    if (!is_folder_name(name)) {
      add_fault(faults_, entry.place,
                "'{}' is no name for a {}: at most 100 letters, digits, '_', '-' and '.', beginning with a "
                "letter, a digit or '_'",
                shown(name), to_string(kind));
    } else if (std::ranges::any_of(parts, is_same)) {
      add_fault(faults_, entry.place,
                "the {} '{}' is there twice; give each once, or names of their own (NAME: file)",
                to_string(kind), name);
    } else {
      parts.push_back({name, entry.place, read(kind, name, entry.value), role});
    }
  }

  [[nodiscard]] YamlNode from_file(PartKind kind, const YamlNode& text) {
    const auto file = part_file(kind, text, faults_);
    if (!file) return make_node(NodeKind::invalid, text.place);
    const std::size_t before = faults_.size();
    auto tree = parse_yaml(read_text_file(*file), origin_of(*file), faults_);
    return tree && faults_.size() == before ? *std::move(tree) : make_node(NodeKind::invalid, text.place);
  }

  template <class... Values>
  [[nodiscard]] YamlNode refuse(const Place& place, fmt::format_string<const Values&...> message,
                                const Values&... values) {
    add_fault(faults_, place, message, values...);
    return make_node(NodeKind::invalid, place);
  }

  const YamlNode& experiment_;
  AnyParams& params_;
  std::vector<Fault>& faults_;
};

/// Takes what names a suite out of the experiment, and puts the suite's seeds in; returns its cases, as
/// written.
std::optional<YamlNode> take_suite(YamlNode& experiment, Products& products, std::vector<Fault>& faults) {
  const auto named = take(experiment, "suite");
  const auto share = take(experiment, "share");
  if (!named) {
    if (share) add_fault(faults, share->place, "share: is one of a suite's starts; name the suite, too");
    return std::nullopt;
  }
  products.given = true;
  auto read = read_suite_file(*named, faults);
  if (!read) return std::nullopt;
  const Suite& suite = read->suite;
  for (const YamlEntry& own : experiment.entries) {
    if (is_key_of_suite(own.key))
      add_fault(faults, own.place, "{}: {} has its own; leave it out", own.key, suite.id());
  }
  if (share) {
    const Refusal why = take_value(*share, {.doc = "", .max = 1.0, .above = 0.0}, products.share);
    if (why) add_fault(faults, share->place, "share: {}", *why);
    if (!suite.is_pinned)
      add_fault(faults, share->place,
                "share: {} does not say yet how many starts it has; glocal leaderboard pin tells what to add",
                suite.id());
  }
  if (find_entry(experiment, "name") == nullptr) {
    const std::string name = fmt::format("{}-{}", suite.name, suite.version);
    experiment.entries.push_back({"name", named->place, make_scalar(named->place, name)});
  }
  experiment.entries.push_back({"seeds", named->place, std::move(read->seeds)});
  if (read->disturbances.kind != NodeKind::null)
    experiment.entries.push_back({disturbances_key, named->place, std::move(read->disturbances)});
  products.suite = std::make_shared<const Suite>(std::move(read->suite));
  return std::move(read->cases);
}

/// What a tree says, whatever the order of its keys.
std::string sorted_text(YamlNode tree) {
  const auto sort = [](YamlNode& node, const auto& again) -> void {
    std::ranges::sort(node.entries, {}, &YamlEntry::key);
    for (YamlEntry& entry : node.entries) again(entry.value, again);
    for (YamlNode& item : node.items) again(item, again);
  };
  sort(tree, sort);
  return flow_yaml(tree);
}

/// The suite with what its cases say, which must be what it pins.
std::shared_ptr<const Suite> with_values(const Suite& suite, const std::vector<ExperimentPart>& cases,
                                         std::vector<Fault>& faults) {
  Suite result = suite;
  result.cases.clear();
  for (const ExperimentPart& part : cases) {
    result.cases.push_back({part.name, hash_of(sorted_text(part.tree)), 0});
    if (!suite.is_pinned) continue;
    const SuiteCase* pinned = suite.find_case(part.name);
    const std::string& now = result.cases.back().values;
    if (pinned != nullptr) result.cases.back().starts = pinned->starts;
    if (pinned != nullptr && pinned->values == now) continue;
    add_fault(
        faults, part.place,
        "the case {} is not that of {}: its values have the hash {}, and {} is pinned; bring them back, "
        "or make another version of the suite",
        part.name, suite.id(), now, pinned == nullptr ? "none" : pinned->values);
  }
  return std::make_shared<const Suite>(std::move(result));
}

/// Leaves the cases that an experiment names of a suite's.
void choose_cases(const YamlNode& names, const Suite& suite, std::vector<ExperimentPart>& cases,
                  std::vector<Fault>& faults) {
  std::vector<std::string> all;
  for (const ExperimentPart& part : cases) all.push_back(part.name);
  std::vector<std::string> chosen;
  for (const YamlNode& name : names.kind == NodeKind::list ? names.items : std::vector{names}) {
    chosen.push_back(name.text);
    if (!has(all, name.text))
      add_fault(faults, name.place, "{} has no case '{}'{}", suite.id(), shown(name.text),
                suggestion(name.text, all, "there are"));
  }
  std::erase_if(cases, [&](const ExperimentPart& part) { return !has(chosen, part.name); });
}

}  // namespace

std::optional<fs::path> part_file(PartKind kind, const YamlNode& value, std::vector<Fault>& faults) {
  const std::string& text = value.text;
  const fs::path beside = value.place.origin->folder / text;
  if (is_file_name(text)) {
    if (const auto why = why_unreadable(beside)) {
      add_fault(faults, value.place, "{}: {}", to_string(kind), *why);
      return std::nullopt;
    }
    return beside;
  }
  const auto builtin = find_builtin_part(kind, text);
  std::error_code ignored;
  if (builtin && fs::is_regular_file(beside, ignored)) {
    add_fault(faults, value.place,
              "'{0}' is a {1} that is built in and a file, too; write ./{0} for the file, or rename it", text,
              to_string(kind));
    return std::nullopt;
  }
  if (builtin) return builtin->file;
  add_fault(faults, value.place, "unknown {} '{}'{}; files are named with .yaml", to_string(kind),
            shown(text), suggestion(text, names_of(kind), "built in are"));
  return std::nullopt;
}

bool is_key_of_suite(std::string_view key) {
  constexpr std::array<std::string_view, 4> others = {"seeds", "choose_on", "judge_on", disturbances_key};
  return has(of_cases, key) || has(others, key);
}

bool names_parts(std::string_view path) {
  constexpr std::array<std::string_view, 7> keys = {"methods",        "cases", "choose_on", "judge_on",
                                                    disturbances_key, "suite", "share"};
  return has(keys, path.substr(0, path.find('.')));
}

void drop_replaced(YamlNode& experiment, const std::vector<Override>& of_parts) {
  const auto overrides = [&](std::string_view key) {
    return std::ranges::find(of_parts, key, &Override::first) != of_parts.end();
  };
  const auto has_own = [&](std::string_view key) { return find_entry(experiment, key) != nullptr; };
  const auto has_any = [&](std::initializer_list<std::string_view> keys) {
    return std::ranges::any_of(keys, has_own);
  };
  if (overrides("methods") && !has_own("methods")) take(experiment, "localizer");
  const bool is_of_one_case =
      has_any({"map", "observations"}) && !has_any({"cases", "choose_on", "judge_on", "suite"});
  if (!is_of_one_case || !overrides("cases") || overrides("suite")) return;
  for (const std::string_view key : of_cases) take(experiment, key);
}

Products take_products(YamlNode& experiment, AnyParams& params, std::vector<Fault>& faults) {
  Products products;
  if (experiment.kind != NodeKind::map) return products;
  const auto of_suite = take_suite(experiment, products, faults);
  PartReader reader(experiment, params, faults);
  const auto add = [&](PartKind kind, const char* key, const YamlNode& written, CaseRole role) {
    products.given = true;
    reader.add_all(kind, key, written, role, kind == PartKind::method ? products.methods : products.cases);
  };
  if (const auto methods = take(experiment, "methods"))
    add(PartKind::method, "methods", *methods, CaseRole::none);
  const auto cases = take(experiment, "cases");
  const auto disturbances = take(experiment, disturbances_key);
  const auto disturb = [&] {
    if (disturbances) add_disturbed_cases(*disturbances, products.cases, faults);
  };
  if (of_suite) {
    const std::size_t before = faults.size();
    add(PartKind::the_case, "cases", *of_suite, CaseRole::none);
    disturb();
    if (faults.size() == before) products.suite = with_values(*products.suite, products.cases, faults);
    if (cases) choose_cases(*cases, *products.suite, products.cases, faults);
  } else if (cases) {
    add(PartKind::the_case, "cases", *cases, CaseRole::none);
  }
  for (const auto& [key, role] :
       {std::pair("choose_on", CaseRole::choose), std::pair("judge_on", CaseRole::judge)}) {
    const auto named = take(experiment, key);
    if (!named) continue;
    if (!products.cases.empty() && products.cases.front().role == CaseRole::none)
      add_fault(faults, named->place,
                "{}: there is `cases`, too; leave it out, or write all cases into choose_on and judge_on",
                key);
    add(PartKind::the_case, key, *named, role);
  }
  if (!of_suite) disturb();
  if (!products.cases.empty() && products.cases.front().role == CaseRole::judge)
    add_fault(faults, products.cases.front().place,
              "judge_on: there is no choose_on; say there by which cases to choose what is judged here");
  return products;
}

YamlNode read_method(const std::string& name, AnyParams& params) {
  std::vector<Fault> faults;
  const YamlNode value = make_scalar({std::make_shared<const Origin>(Origin{"--method " + name, "."})}, name);
  const YamlNode no_experiment = make_node(NodeKind::map, value.place);
  YamlNode method = PartReader(no_experiment, params, faults).read(PartKind::method, name, value);
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return method;
}

YamlNode joined(const YamlNode& experiment, const ExperimentPart* method, const ExperimentPart* one_case,
                AnyParams& params, std::vector<Fault>& faults) {
  if (method == nullptr && one_case == nullptr) return experiment;
  YamlNode tree = make_node(NodeKind::map, experiment.place);
  for (const ExperimentPart* part : {one_case, method}) {
    if (part == nullptr) continue;
    tree.entries.insert(tree.entries.end(), part->tree.entries.begin(), part->tree.entries.end());
  }
  lay_over(tree, experiment, params, faults);
  return tree;
}

}  // namespace glocal
