#include "evaluation/sweeps/setting_values.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "config/field_docs.hpp"
#include "config/writer.hpp"
#include "config/yaml_parser.hpp"
#include "glocal/experiment.hpp"

namespace glocal {
namespace {

/// Adds where a struct chooses a strategy.
void add_choices(const StructDoc& doc, const std::string& above, std::vector<std::string>& choices) {
  for (const FieldDoc& field : doc.fields) {
    if (field.type == FieldType::strategy) choices.push_back(above + field.name);
    for (const StructDoc& inner : field.inner) add_choices(inner, above + field.name + ".", choices);
  }
}

/// The choice of an experiment that a path is of, or is below; none for others.
std::optional<std::string> choice_of(const std::string& path) {
  static const std::vector<std::string> choices = [] {
    Experiment experiment;
    const Catalog no_strategies;
    DescribedBy params([&](ParamVisitor& v) { describe(v, experiment, no_strategies); });
    std::vector<std::string> found;
    add_choices(document(params), "", found);
    return found;
  }();
  for (const std::string& choice : choices) {
    if (path == choice || path.starts_with(choice + ".")) return choice;
  }
  return std::nullopt;
}

/// The name behind a choice in a path below it.
std::string strategy_in(const std::string& path, const std::string& choice) {
  const std::size_t begin = choice.size() + 1;
  return path.substr(begin, path.find('.', begin) - begin);
}

void put(const std::string& path, const std::string& value, SettingValues& values) {
  if (std::ranges::find(values, path, &SettingValues::value_type::first) == values.end())
    values.emplace_back(path, value);
}

/// `dbscan`, or `{dbscan: {eps: 1}}`.
void put_choice(const std::string& choice, const std::string& text, SettingValues& values) {
  std::vector<Fault> faults;
  const auto node =
      parse_yaml_value(text, std::make_shared<const Origin>(Origin{"a value of a setting", "."}), faults);
  if (!node || !faults.empty() || node->kind != NodeKind::map || node->entries.size() != 1) {
    put(choice, text, values);
    return;
  }
  const YamlEntry& strategy = node->entries.front();
  put(choice, strategy.key, values);
  for (const YamlEntry& parameter : strategy.value.entries)
    put(choice + "." + strategy.key + "." + parameter.key, flow_yaml(parameter.value), values);
}

SettingValues unfolded(const SettingValues& written) {
  SettingValues values;
  for (const auto& [path, text] : written) {
    const auto choice = choice_of(path);
    if (choice == path) {
      put_choice(path, text, values);
      continue;
    }
    if (choice) put(*choice, strategy_in(path, *choice), values);
    put(path, text, values);
  }
  return values;
}

/// The value of a parameter, or the strategy of a choice; none for a parameter of a strategy that did not
/// run.
std::optional<std::string> value_as_run(const std::string& path,
                                        const std::map<std::string, Setting>& effective) {
  if (choice_of(path) == path) {
    const auto below = effective.lower_bound(path + ".");
    if (below != effective.end() && below->first.starts_with(path + "."))
      return strategy_in(below->first, path);
  }
  const auto itself = effective.find(path);
  return itself == effective.end() ? std::nullopt : std::optional(itself->second.text);
}

}  // namespace

std::vector<SettingValues> comparable_values(const std::vector<SettingAsRun>& settings) {
  std::vector<SettingValues> result;
  std::set<std::string> named;
  for (const SettingAsRun& setting : settings) {
    for (const auto& [path, value] : result.emplace_back(unfolded(setting.values))) named.insert(path);
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    for (const std::string& path : named) {
      if (const auto value = value_as_run(path, *settings[i].effective)) put(path, *value, result[i]);
    }
  }
  return result;
}

}  // namespace glocal
