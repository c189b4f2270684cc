#include "evaluation/sweeps/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "config/variants.hpp"
#include "evaluation/results/number_text.hpp"
#include "evaluation/statistics/ranks.hpp"

namespace glocal {
namespace {

/// The values of one parameter: for each setting, if it has one.
struct Column {
  std::string path;
  std::vector<std::optional<std::string>> texts;
  std::vector<std::optional<double>> numbers;
  bool is_numeric = true;
};

std::vector<Column> columns_of(const std::vector<TriedSetting>& settings) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    for (const auto& [path, value] : settings[i].values) {
      auto column = std::ranges::find(columns, path, &Column::path);
      if (column == columns.end()) {
        columns.push_back({path, std::vector<std::optional<std::string>>(settings.size()),
                           std::vector<std::optional<double>>(settings.size())});
        column = columns.end() - 1;
      }
      column->texts[i] = value;
      column->numbers[i] = number_of<double>(value);
      column->is_numeric &= column->numbers[i].has_value();
    }
  }
  return columns;
}

std::vector<double> all_numbers(const Column& column) {
  std::vector<double> numbers;
  for (const std::optional<double>& number : column.numbers) {
    if (number) numbers.push_back(*number);
  }
  return numbers;
}

/// A level for each value: numbers by size, the texts as they first occur.
void use_single_values(const Column& column, ParameterEffect& effect) {
  std::vector<std::pair<double, std::string>> values;
  const auto place_of = [&](std::size_t i) {
    return std::find_if(values.begin(), values.end(), [&](const auto& value) {
      return column.is_numeric ? value.first == *column.numbers[i] : value.second == *column.texts[i];
    });
  };
  for (std::size_t i = 0; i < column.texts.size(); ++i) {
    if (column.texts[i] && place_of(i) == values.end())
      values.emplace_back(column.numbers[i].value_or(0.0), *column.texts[i]);
  }
  if (column.is_numeric) std::sort(values.begin(), values.end());
  for (const auto& [number, text] : values) effect.levels.push_back({.label = text});
  for (std::size_t i = 0; i < column.texts.size(); ++i) {
    if (column.texts[i]) effect.level_of[i] = static_cast<std::size_t>(place_of(i) - values.begin());
  }
}

/// Four digits, or all of a larger number.
std::string edge_text(double edge) {
  constexpr double large = 1e4;
  constexpr double too_large = 1e15;
  const bool is_plain = std::abs(edge) >= large && std::abs(edge) < too_large;
  return is_plain ? fmt::format("{:.0f}", edge) : fmt::format("{:.4g}", edge);
}

/// A level for each quarter of the values.
void use_quarters(const Column& column, ParameterEffect& effect) {
  effect.is_binned = true;
  const std::vector<double> numbers = all_numbers(column);
  std::vector<double> edges;
  for (const double p : {0.0, 0.25, 0.5, 0.75, 1.0}) edges.push_back(quantile(numbers, p));
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (std::size_t k = 0; k + 1 < edges.size(); ++k)
    effect.levels.push_back({.label = edge_text(edges[k]) + " to " + edge_text(edges[k + 1])});
  for (std::size_t i = 0; i < column.numbers.size(); ++i) {
    if (!column.numbers[i]) continue;
    // An edge belongs to the quarter below it, and the smallest value to the first.
    const auto above = std::lower_bound(edges.begin() + 1, edges.end() - 1, *column.numbers[i]);
    effect.level_of[i] = static_cast<std::size_t>(above - edges.begin()) - 1;
  }
}

void count_levels(const std::vector<TriedSetting>& settings, ParameterEffect& effect) {
  std::vector<Tally> groups(effect.levels.size());
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (effect.level_of[i]) groups[*effect.level_of[i]].add(settings[i].trials);
  }
  double least = 1.0;
  double most = 0.0;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const SettingOutcome& outcome = effect.levels[k].outcome = groups[k].outcome();
    if (outcome.trials == 0) continue;
    least = std::min(least, outcome.success.value);
    most = std::max(most, outcome.success.value);
  }
  effect.range = std::max(0.0, most - least);
}

std::optional<double> correlation(const Column& column, const std::vector<TriedSetting>& settings) {
  std::vector<double> values;
  std::vector<double> successes;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (!column.numbers[i]) continue;
    const SettingOutcome outcome = settings[i].trials.outcome();
    if (outcome.trials == 0) continue;
    values.push_back(*column.numbers[i]);
    successes.push_back(outcome.success.value);
  }
  return values.size() < 3 ? std::nullopt : spearman(values, successes);
}

}  // namespace

void Tally::add(const std::string& case_name, const std::map<TrialStart, TrialResult>& trials,
                bool with_times) {
  for (const auto& [start, trial] : trials) {
    const bool is_right = trial.outcome == Outcome::right;
    Ends& ends = places_[{case_name, start.sample}];
    ++ends.trials;
    ends.right += is_right ? 1 : 0;
    ends.wrong += trial.outcome == Outcome::wrong ? 1 : 0;
    ends.failed += trial.outcome == Outcome::failed ? 1 : 0;
    ends.declared += trial.outcome == Outcome::declared ? 1 : 0;
    if (is_right) steps_.push_back(trial.steps);
    if (with_times && trial.step_cpu_ms) step_cpu_ms_.push_back(*trial.step_cpu_ms);
  }
}

void Tally::add(const Tally& setting) {
  ++settings_;
  for (const auto& [place, ends] : setting.places_) {
    Ends& sum = places_[place];
    sum.trials += ends.trials;
    sum.right += ends.right;
    sum.wrong += ends.wrong;
    sum.failed += ends.failed;
    sum.declared += ends.declared;
  }
  steps_.insert(steps_.end(), setting.steps_.begin(), setting.steps_.end());
  step_cpu_ms_.insert(step_cpu_ms_.end(), setting.step_cpu_ms_.begin(), setting.step_cpu_ms_.end());
}

SettingOutcome Tally::outcome() const {
  SettingOutcome outcome{.settings = settings_,
                         .median_steps = median_if_any(steps_),
                         .median_step_cpu_ms = median_if_any(step_cpu_ms_)};
  std::vector<TrialCluster> right, wrong;
  for (const auto& [place, ends] : places_) {
    outcome.trials += ends.trials;
    outcome.right += ends.right;
    outcome.wrong += ends.wrong;
    outcome.failed += ends.failed;
    outcome.declared += ends.declared;
    right.push_back({ends.right, ends.trials});
    wrong.push_back({ends.wrong, ends.trials});
  }
  outcome.success = wilson_of_clusters(right);
  outcome.false_rate = wilson_of_clusters(wrong);
  return outcome;
}

std::vector<ParameterEffect> effects_of(const std::vector<TriedSetting>& settings) {
  const std::vector<Column> columns = columns_of(settings);
  std::vector<std::string> paths;
  for (const Column& column : columns) paths.push_back(column.path);
  std::vector<ParameterEffect> effects;
  for (const Column& column : columns) {
    ParameterEffect effect{.path = column.path, .label = distinct_end(column.path, paths)};
    effect.level_of.resize(settings.size());
    const std::vector<double> numbers = all_numbers(column);
    const std::set<double> different(numbers.begin(), numbers.end());
    if (column.is_numeric && different.size() > most_single_values) {
      use_quarters(column, effect);
    } else {
      use_single_values(column, effect);
    }
    if (effect.levels.size() < 2) continue;
    count_levels(settings, effect);
    if (column.is_numeric) effect.spearman = correlation(column, settings);
    effects.push_back(std::move(effect));
  }
  std::ranges::stable_sort(effects, std::greater<>(), &ParameterEffect::range);
  return effects;
}

HeatMap heat_map(const std::vector<TriedSetting>& settings, const std::vector<ParameterEffect>& effects,
                 std::size_t row, std::size_t column) {
  const ParameterEffect& rows = effects[row];
  const ParameterEffect& columns = effects[column];
  std::vector<std::vector<Tally>> groups(rows.levels.size(), std::vector<Tally>(columns.levels.size()));
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (rows.level_of[i] && columns.level_of[i])
      groups[*rows.level_of[i]][*columns.level_of[i]].add(settings[i].trials);
  }
  HeatMap map{row, column, {}};
  for (const std::vector<Tally>& in_row : groups) {
    map.cells.emplace_back();
    for (const Tally& group : in_row) map.cells.back().push_back(group.outcome());
  }
  return map;
}

}  // namespace glocal
