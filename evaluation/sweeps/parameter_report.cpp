#include "evaluation/sweeps/parameter_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "evaluation/results/proportions.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

Table effect_table(const ParameterEffect& effect) {
  const bool with_times = std::ranges::any_of(
      effect.levels, [](const auto& level) { return level.outcome.median_step_cpu_ms.has_value(); });
  Table table{{effect.label, "settings", "trials", "right, %, 95 %", "wrong", "steps"}, {}};
  if (with_times) table.header.emplace_back("CPU time of a step, ms");
  for (const auto& [label, outcome] : effect.levels) {
    table.rows.push_back({label, std::to_string(outcome.settings), std::to_string(outcome.trials),
                          outcome.trials == 0 ? "-" : per_cent(outcome.success),
                          std::to_string(outcome.wrong), steps_cell(outcome.median_steps)});
    const auto& ms = outcome.median_step_cpu_ms;
    if (with_times) table.rows.back().push_back(ms ? fmt::format("{:.3g}", *ms) : "-");
  }
  return table;
}

std::string effect_heading(const ParameterEffect& effect) {
  return fmt::format(
      "{}: {} points from the worst to the best{}{}", effect.path, points(effect.range),
      effect.is_binned ? ", by quarters of its values" : "",
      effect.spearman ? fmt::format("; rank correlation {:+.2f}", *effect.spearman + 0.0) : "");
}

/// "83 ####.": in print, and for whoever cannot tell colours apart, too.
std::string share_cell(const SettingOutcome& outcome) {
  if (outcome.trials == 0) return "-      ";
  constexpr int most = 5;
  const double share = outcome.success.value;
  const int length = static_cast<int>(std::lround(most * share));
  return fmt::format("{:.0f} {:#<{}}{:.<{}}", 100.0 * share, "", length, "", most - length);
}

Table map_table(const ParameterFigures& figures, std::string (*cell_of)(const SettingOutcome&)) {
  const ParameterEffect& rows = figures.effects[figures.map->row];
  const ParameterEffect& columns = figures.effects[figures.map->column];
  Table table{{rows.label + " \\ " + columns.label}, {}};
  for (const ParameterLevel& level : columns.levels) table.header.push_back(level.label);
  for (std::size_t r = 0; r < rows.levels.size(); ++r) {
    table.rows.push_back({rows.levels[r].label});
    for (const SettingOutcome& outcome : figures.map->cells[r]) table.rows.back().push_back(cell_of(outcome));
  }
  return table;
}

Json group_json(const SettingOutcome& outcome) {
  Json json = {{"settings", outcome.settings},
               {"trials", outcome.trials},
               {"wrong", outcome.wrong},
               {"success_rate", to_json(outcome.success)}};
  if (outcome.median_steps) json["median_steps"] = *outcome.median_steps;
  if (outcome.median_step_cpu_ms) json["median_step_cpu_ms"] = *outcome.median_step_cpu_ms;
  return json;
}

Json to_json(const ParameterEffect& effect) {
  Json levels = Json::array();
  for (const ParameterLevel& level : effect.levels) {
    levels.push_back({{"label", level.label}});
    levels.back().update(group_json(level.outcome));
  }
  Json json = {{"path", effect.path},
               {"label", effect.label},
               {"quarters", effect.is_binned},
               {"range", effect.range}};
  if (effect.spearman) json["spearman"] = *effect.spearman;
  json["levels"] = std::move(levels);
  return json;
}

Json to_json(const HeatMap& map, const std::vector<ParameterEffect>& effects) {
  Json cells = Json::array();
  for (const auto& row : map.cells) {
    cells.push_back(Json::array());
    for (const SettingOutcome& outcome : row) cells.back().push_back(group_json(outcome));
  }
  const auto axis = [&](std::size_t i) {
    Json labels = Json::array();
    for (const ParameterLevel& level : effects[i].levels) labels.push_back(level.label);
    return Json{{"path", effects[i].path}, {"label", effects[i].label}, {"levels", std::move(labels)}};
  };
  return {{"rows", axis(map.row)}, {"columns", axis(map.column)}, {"cells", std::move(cells)}};
}

}  // namespace

std::string points(double share) {
  // Adding 0 turns -0 into 0.
  return fmt::format("{:.1f}", 100.0 * share + 0.0);
}

std::string steps_cell(const std::optional<double>& median_steps) {
  return median_steps ? fmt::format("{:g}", *median_steps) : "-";
}

Report parameter_report(const ParameterFigures& figures) {
  Report report;
  for (const ParameterEffect& effect : figures.effects) {
    report.emplace_back(Heading{effect_heading(effect)});
    report.emplace_back(effect_table(effect));
  }
  if (figures.map) {
    report.emplace_back(Heading{"Right trials, %, by two parameters"});
    report.emplace_back(map_table(figures, share_cell));
    report.emplace_back(Heading{"Steps to localize, median of right trials, by two parameters"});
    report.emplace_back(
        map_table(figures, [](const SettingOutcome& o) { return steps_cell(o.median_steps); }));
  }
  return report;
}

Json to_json(const ParameterFigures& figures) {
  Json json = {{"effects", Json::array()}};
  for (const ParameterEffect& effect : figures.effects) json["effects"].push_back(to_json(effect));
  if (figures.map) json["map"] = to_json(*figures.map, figures.effects);
  return json;
}

}  // namespace glocal
