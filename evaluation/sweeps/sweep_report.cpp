#include "evaluation/sweeps/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "config/nearest.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/proportions.hpp"
#include "evaluation/results/report_blocks.hpp"
#include "evaluation/sweeps/parameter_report.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

/// Of the best settings, so many are shown with their values, and where they are judged.
constexpr std::size_t most_looked_at = 5;

/// A name as it is shown, of a setting without one, too.
std::string shown_name(const std::string& name) {
  return name.empty() ? "(the experiment)" : name;
}

std::string name_of(const SettingResult& setting) {
  return shown_name(setting.name) + (setting.complete ? "" : " *");
}

double lead_points(const Lead& lead, const ChanceOfBest& chance) {
  return 100.0 * static_cast<double>(lead.score) / static_cast<double>(chance.trials) + 0.0;
}

std::vector<std::string> outcome_cells(const SettingOutcome& o) {
  return {std::to_string(o.trials),  std::to_string(o.right),
          std::to_string(o.wrong),   std::to_string(o.trials - o.right - o.wrong),
          per_cent(o.success),       points(o.score()),
          steps_cell(o.median_steps)};
}

const std::vector<std::string>& outcome_columns() {
  static const std::vector<std::string> columns = {"trials",  "right", "wrong", "undecided",
                                                   "%, 95 %", "score", "steps"};
  return columns;
}

/// Of the score: ahead of the baseline, at how many places better and worse, and p.
std::vector<std::string> lead_cells(const std::optional<Lead>& lead, const ChanceOfBest& chance) {
  if (!lead) return {"", "", "", ""};
  return {fmt::format("{:+.1f}", lead_points(*lead, chance)), std::to_string(lead->places_better),
          std::to_string(lead->places_worse), p_value(lead->p)};
}

Table settings_table(const SweepAnalysis& analysis, std::size_t most) {
  Table table{{"setting"}, {}};
  table.header.insert(table.header.end(), outcome_columns().begin(), outcome_columns().end());
  if (analysis.chance) table.header.insert(table.header.end(), {"ahead", "better", "worse", "p"});
  for (std::size_t i = 0; i < std::min(most, analysis.settings.size()); ++i) {
    const SettingResult& setting = analysis.settings[i];
    table.rows.push_back({name_of(setting)});
    for (std::string& cell : outcome_cells(setting.chosen)) table.rows.back().push_back(std::move(cell));
    if (!analysis.chance) continue;
    for (std::string& cell : lead_cells(setting.over_baseline, *analysis.chance))
      table.rows.back().push_back(std::move(cell));
  }
  return table;
}

Table judged_table(const SweepAnalysis& analysis) {
  Table table{{"setting", "chosen by: %, 95 %", "wrong", "judged: %, 95 %", "right", "wrong", "trials"}, {}};
  for (const SettingResult& setting : analysis.settings) {
    if (table.rows.size() == most_looked_at) break;
    if (!setting.judged) continue;
    const SettingOutcome& judged = *setting.judged;
    table.rows.push_back({name_of(setting), per_cent(setting.chosen.success),
                          std::to_string(setting.chosen.wrong), per_cent(judged.success),
                          std::to_string(judged.right), std::to_string(judged.wrong),
                          std::to_string(judged.trials)});
  }
  return table;
}

/// What the best settings change; a parameter has the column of its effect.
Table values_table(const SweepAnalysis& analysis) {
  Table table{{"setting"}, {}};
  for (const ParameterEffect& effect : analysis.parameters.effects) table.header.push_back(effect.label);
  for (const SettingResult& setting : analysis.settings) {
    if (table.rows.size() == most_looked_at) break;
    table.rows.push_back({name_of(setting)});
    for (const ParameterEffect& effect : analysis.parameters.effects) {
      const auto value = std::ranges::find(setting.values, effect.path, &SettingValues::value_type::first);
      table.rows.back().push_back(value == setting.values.end() ? "-" : value->second);
    }
  }
  return table;
}

std::string cases_text(const std::vector<std::string>& cases) {
  return cases.empty() ? "all runs" : join(cases);
}

std::string heading(const SweepAnalysis& a) {
  const std::size_t cases = a.choose_on.size() + a.judge_on.size();
  return fmt::format("{}: {}, {}, {}{}", a.experiment, counted(a.runs, "run"),
                     counted(a.settings.size(), "setting"), counted(a.seeds.size(), "seed"),
                     cases == 0 ? "" : ", " + counted(cases, "case"));
}

/// The best, and how many are as good: then only its name has put it first.
std::string best_of(const SweepAnalysis& a) {
  const SettingResult& best = a.settings.front();
  const auto alike = std::count_if(a.settings.begin(), a.settings.end(), [&](const SettingResult& s) {
    return s.complete && s.chosen.score() == best.chosen.score() &&
           s.chosen.median_steps == best.chosen.median_steps;
  });
  if (alike < 2) return name_of(best);
  return fmt::format("{}, the first of {} with the same score and steps,", name_of(best), alike);
}

/// "2.5 points ahead of B (better at 3 places, worse at 1; p = 0.625)".
std::string lead_text(const Lead& lead, const std::string& other, const ChanceOfBest& chance) {
  return fmt::format("{:.1f} points ahead of {} (better at {} places, worse at {}; {})",
                     lead_points(lead, chance), other, lead.places_better, lead.places_worse, p_text(lead.p));
}

std::string against_second(const SweepAnalysis& a) {
  const ChanceOfBest& c = *a.chance;
  const double ceiling = 1.0 - c.score_of_second;
  std::string text = "It is " + lead_text(c.over_second, shown_name(c.second) + ", the second best", c);
  if (ceiling <= 0.0) return text + ", which has no score left to win: nothing can be ahead of it.";
  if (c.over_second.p < significance) return text + ".";
  return text +
         fmt::format(", of which it could be at most {} ahead. Both may be equally good.", points(ceiling));
}

std::string against_baseline(const SweepAnalysis& a) {
  const SettingResult& best = a.settings.front();
  const std::string baseline = shown_name(a.chance->baseline) + ", the baseline";
  if (!best.over_baseline) return fmt::format("No setting has a better score than {}.", baseline);
  return fmt::format("It is {}. {}", lead_text(*best.over_baseline, baseline, *a.chance),
                     best.over_baseline->p < significance
                         ? "So there is more to it than chance, but part of the lead may not last."
                         : "So it may be no better than that.");
}

std::string chance_warning(const SweepAnalysis& a) {
  std::string text = fmt::format(
      "{} was chosen among {} settings by the very trials that its numbers are of, so they flatter it. ",
      best_of(a), a.settings.size());
  text += against_baseline(a);
  // Said already where the second best is the baseline.
  if (a.chance->second != a.chance->baseline || !a.settings.front().over_baseline)
    text += " " + against_second(a);
  return text;
}

/// Settings that are behind the baseline by more than chance.
std::optional<std::string> worse_than_baseline(const SweepAnalysis& a) {
  std::vector<std::string> worse;
  for (const SettingResult& setting : a.settings) {
    if (setting.over_baseline && setting.over_baseline->score < 0 && setting.over_baseline->p < significance)
      worse.push_back(fmt::format("{} ({:+.1f} points)", shown_name(setting.name),
                                  lead_points(*setting.over_baseline, *a.chance)));
  }
  if (worse.empty()) return std::nullopt;
  constexpr std::size_t most_named = 5;
  const std::size_t more = worse.size() > most_named ? worse.size() - most_named : 0;
  worse.resize(worse.size() - more);
  return fmt::format("Worse than {} by more than chance: {}{}.", shown_name(a.chance->baseline), join(worse),
                     more > 0 ? fmt::format(", {} more", more) : "");
}

std::string report_advice(const SweepAnalysis& a) {
  const auto& best = a.settings.front();
  if (best.judged)
    return fmt::format(
        "The number to report is that of {}, where nothing was chosen: {} is right in {} %, with {} of {} "
        "trials wrong.",
        join(a.judge_on), name_of(best), per_cent(best.judged->success), best.judged->wrong,
        best.judged->trials);
  return "Judge the best by other logs or worlds (judge_on), and report what comes of that.";
}

Json to_json(const SettingOutcome& o) {
  Json json = {{"trials", o.trials},
               {"right", o.right},
               {"wrong", o.wrong},
               {"undecided", o.trials - o.right - o.wrong},
               {"success_rate", to_json(o.success)},
               {"false_rate", to_json(o.false_rate)},
               {"score", o.score()}};
  if (o.median_steps) json["median_steps"] = *o.median_steps;
  return json;
}

Json to_json(const Lead& lead, const ChanceOfBest& chance) {
  return {{"lead", lead_points(lead, chance) / 100.0},
          {"places_better", lead.places_better},
          {"places_worse", lead.places_worse},
          {"p", lead.p}};
}

Json to_json(const SettingResult& s, const std::optional<ChanceOfBest>& chance) {
  Json values = Json::object();
  for (const auto& [path, value] : s.values) values[path] = value;
  Json json = {
      {"setting", s.name}, {"values", values}, {"complete", s.complete}, {"chosen", to_json(s.chosen)}};
  if (s.judged) json["judged"] = to_json(*s.judged);
  if (s.over_baseline) json["over_baseline"] = to_json(*s.over_baseline, *chance);
  return json;
}

Json to_json(const ChanceOfBest& c) {
  Json second = {{"setting", c.second}};
  second.update(to_json(c.over_second, c));
  second["most"] = 1.0 - c.score_of_second;
  return {{"places", c.places}, {"trials", c.trials}, {"baseline", c.baseline}, {"over_second", second}};
}

}  // namespace

std::vector<std::string> warnings_of(const SweepAnalysis& a) {
  std::vector<std::string> warnings;
  if (!a.incomplete.empty())
    warnings.push_back(
        fmt::format("{} without all trials, of interrupted runs: {}. Run the same command again.",
                    counted(a.incomplete.size(), "run"), join(a.incomplete)));
  const auto missing = std::ranges::count(a.settings, false, &SettingResult::complete);
  if (missing > 0)
    warnings.push_back(
        fmt::format("{} without all cases, seeds or trials, marked with *: listed last, and never "
                    "the best.",
                    counted(static_cast<std::size_t>(missing), "setting")));
  std::size_t failed = 0, declared = 0;
  for (const SettingResult& setting : a.settings) {
    for (const SettingOutcome& outcome : {setting.chosen, setting.judged.value_or(SettingOutcome{})}) {
      failed += outcome.failed;
      declared += outcome.declared;
    }
  }
  if (failed > 0)
    warnings.push_back(fmt::format("{} trials failed with an exception; they count as undecided.", failed));
  if (declared > 0)
    warnings.push_back(fmt::format(
        "{} declarations have no reference to judge them by; they count as undecided.", declared));
  if (!a.why_not_compared.empty())
    warnings.push_back(fmt::format("Nothing is compared: {}.", a.why_not_compared));
  const bool differ = a.chance && std::ranges::any_of(a.settings, [&](const SettingResult& setting) {
                        return setting.complete && setting.chosen.trials != a.chance->trials;
                      });
  if (differ)
    warnings.push_back(fmt::format(
        "Settings have other starts: scores are of all of them, \"ahead\" is of the {} that all have.",
        a.chance->trials));
  if (a.settings.size() < 2 || !a.settings.front().complete) return warnings;
  if (a.chance) {
    warnings.push_back(chance_warning(a));
    if (const auto worse = worse_than_baseline(a)) warnings.push_back(*worse);
  }
  warnings.push_back(report_advice(a));
  return warnings;
}

std::string text_report(const SweepAnalysis& analysis, std::size_t most_settings) {
  Report report;
  report.emplace_back(Heading{heading(analysis)});
  if (const auto warnings = warnings_of(analysis); !warnings.empty()) report.emplace_back(List{warnings});
  report.emplace_back(Heading{"Settings, best first, by " + cases_text(analysis.choose_on)});
  report.emplace_back(settings_table(analysis, most_settings));
  if (analysis.settings.size() > most_settings)
    report.emplace_back(Paragraph{fmt::format("{} more; --top {} shows all.",
                                              counted(analysis.settings.size() - most_settings, "setting"),
                                              analysis.settings.size())});
  if (!analysis.judge_on.empty()) {
    report.emplace_back(Heading{"The best of these, judged by " + join(analysis.judge_on)});
    report.emplace_back(judged_table(analysis));
  }
  if (!analysis.parameters.effects.empty()) {
    report.emplace_back(Heading{"Values of the best"});
    report.emplace_back(values_table(analysis));
  }
  const Report parameters = parameter_report(analysis.parameters);
  report.insert(report.end(), parameters.begin(), parameters.end());
  report.emplace_back(Heading{"How to read this"});
  report.emplace_back(Paragraph{
      "Score: right less wrong trials, in percentage points of all. Settings are ranked by it, then by fewer "
      "steps to localize (median of right trials). Intervals are Wilson's for as many independent trials as "
      "tell as much as these, since trials at one place tend to end alike. What a parameter does is the mean "
      "over all else that varies. \"ahead\" is the score less that of the baseline, \"better\" and \"worse\" "
      "count places; p is of the largest of all these differences, by signs of places."});
  return as_text(report);
}

Json to_json(const SweepAnalysis& a) {
  Json json = {{"experiment", a.experiment}, {"runs", a.runs},   {"choose_on", a.choose_on},
               {"judge_on", a.judge_on},     {"seeds", a.seeds}, {"incomplete", a.incomplete},
               {"warnings", warnings_of(a)}};
  json["settings"] = Json::array();
  for (const SettingResult& setting : a.settings) json["settings"].push_back(to_json(setting, a.chance));
  json.update(to_json(a.parameters));
  if (a.chance) json["chance"] = to_json(*a.chance);
  return json;
}

std::string json_text(const SweepAnalysis& analysis) {
  return json_text(to_json(analysis), 2) + "\n";
}

}  // namespace glocal
