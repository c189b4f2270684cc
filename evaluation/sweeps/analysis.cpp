#include "evaluation/sweeps/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "config/nearest.hpp"
#include "evaluation/comparison/comparability.hpp"
#include "evaluation/comparison/methods.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

struct TalliedSetting {
  SettingResult result;
  Tally chosen, judged;
  std::vector<const SweepRun*> runs;
};

using CaseAndSeed = std::pair<std::string, std::uint64_t>;

std::set<CaseAndSeed> cells_of(const std::vector<const SweepRun*>& runs) {
  std::set<CaseAndSeed> cells;
  for (const SweepRun* run : runs) cells.emplace(run->part.case_name, run->part.seed);
  return cells;
}

/// In the order of their first run.
std::vector<TalliedSetting> settings_of(const std::vector<SweepRun>& runs, bool with_times) {
  std::vector<TalliedSetting> settings;
  std::map<std::string, std::size_t> numbers;
  std::vector<const SweepRun*> all;
  for (const SweepRun& run : runs) {
    const auto [number, is_new] = numbers.try_emplace(run.part.setting, settings.size());
    if (is_new) {
      settings.emplace_back();
      settings.back().result.name = run.part.setting;
    }
    settings[number->second].runs.push_back(&run);
    all.push_back(&run);
  }
  const std::set<CaseAndSeed> cells = cells_of(all);
  std::vector<SettingAsRun> written;
  for (TalliedSetting& setting : settings) {
    written.push_back({setting.runs.front()->part.values, setting.runs.front()->effective});
    for (const SweepRun* run : setting.runs)
      (run->part.role == CaseRole::judge ? setting.judged : setting.chosen)
          .add(run->part.case_name, *run->trials, with_times);
    setting.result.complete =
        cells_of(setting.runs) == cells && std::ranges::all_of(setting.runs, &SweepRun::complete);
    setting.result.chosen = setting.chosen.outcome();
    const SettingOutcome judged = setting.judged.outcome();
    if (judged.trials > 0) setting.result.judged = judged;
  }
  std::vector<SettingValues> values = comparable_values(written);
  for (std::size_t i = 0; i < settings.size(); ++i) settings[i].result.values = std::move(values[i]);
  return settings;
}

/// Whether the one is ranked before the other; equal ones stay as they are.
bool is_better(const SettingResult& a, const SettingResult& b) {
  const auto key = [](const SettingResult& s) {
    return std::tuple(!s.complete, -s.chosen.score(),
                      s.chosen.median_steps.value_or(std::numeric_limits<double>::infinity()));
  };
  return key(a) < key(b);
}

/// A complete setting and what it was chosen by.
Method as_method(const TalliedSetting& setting) {
  Method method{setting.result.name, {}};
  for (const SweepRun* run : setting.runs) {
    if (run->part.role != CaseRole::judge)
      method.runs.push_back({run->part.case_name, run->part.seed, run->index});
  }
  return method;
}

std::vector<ScoresAtPlace> scores_at_places(const PairedTrials& paired) {
  std::vector<ScoresAtPlace> places;
  for (const PairedTrials::Place& place : paired.places) {
    ScoresAtPlace& scores = places.emplace_back(paired.results.size());
    for (std::size_t m = 0; m < scores.size(); ++m) {
      for (std::size_t t = place.begin; t < place.end; ++t) {
        const Outcome outcome = paired.results[m][t]->outcome;
        scores[m] += outcome == Outcome::right ? 1 : outcome == Outcome::wrong ? -1 : 0;
      }
    }
  }
  return places;
}

/// Compares all complete settings with the baseline, and the best with the second best.
void compare_settings(const std::vector<NamedRun>& runs, const std::vector<TalliedSetting>& settings,
                      const std::string& baseline, SweepAnalysis& analysis) {
  std::vector<Method> methods;
  for (const TalliedSetting& setting : settings) {
    if (setting.result.complete) methods.push_back(as_method(setting));
  }
  const auto number_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(methods, name, &Method::name) - methods.begin());
  };
  if (methods.size() < 2) return;
  const std::size_t base = baseline.empty() ? 0 : number_of(baseline);
  if (base == methods.size()) {
    analysis.why_not_compared = baseline + ", the baseline, lacks cases, seeds or trials";
    return;
  }
  const PairedTrials paired = pair_trials(runs, methods);
  if (paired.trials.empty()) {
    analysis.why_not_compared = "no start is common to all complete settings";
    return;
  }
  const std::vector<ScoresAtPlace> places = scores_at_places(paired);
  const std::vector<Lead> leads = leads_over(base, places);
  for (SettingResult& setting : analysis.settings) {
    if (setting.complete && setting.name != methods[base].name)
      setting.over_baseline = leads[number_of(setting.name)];
  }
  const SettingResult& second = analysis.settings[1];
  analysis.chance = ChanceOfBest{
      .places = places.size(),
      .trials = paired.trials.size(),
      .baseline = methods[base].name,
      .second = second.name,
      .over_second = lead_of(number_of(analysis.settings.front().name), number_of(second.name), places),
      .score_of_second = second.chosen.score()};
}

void check_setting(const std::string& name, const std::vector<TalliedSetting>& settings) {
  std::vector<std::string> names;
  for (const TalliedSetting& setting : settings) names.push_back(setting.result.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw ConfigError("--baseline " + name,
                      "there is no such setting" + suggestion(name, names, "there are"));
}

/// The parameter of this path or end of a path. Throws ConfigError.
std::size_t number_of_parameter(const std::string& name, const std::vector<ParameterEffect>& effects) {
  std::vector<std::string> paths;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    paths.push_back(effects[i].path);
    if (effects[i].path == name) return i;
    if (effects[i].path.ends_with("." + name)) found.push_back(i);
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    throw ConfigError("--map " + name, "more than one parameter ends so; name its whole path");
  throw ConfigError("--map " + name, "no such parameter varies" + suggestion(name, paths, "there are"));
}

std::optional<std::pair<std::size_t, std::size_t>> chosen_axes(const MapChoice& choice,
                                                               const std::vector<ParameterEffect>& effects) {
  if (!choice)
    return effects.size() < 2 ? std::nullopt : std::optional(std::pair<std::size_t, std::size_t>(0, 1));
  const std::pair axes(number_of_parameter(choice->first, effects),
                       number_of_parameter(choice->second, effects));
  if (axes.first == axes.second)
    throw ConfigError(fmt::format("--map {} {}", choice->first, choice->second),
                      "is one parameter twice; name two");
  return axes;
}

ParameterFigures figures_of(const std::vector<TalliedSetting>& settings, const MapChoice& map) {
  std::vector<TriedSetting> tried;
  for (const TalliedSetting& setting : settings) tried.push_back({setting.result.values, setting.chosen});
  ParameterFigures figures{effects_of(tried), {}};
  if (const auto axes = chosen_axes(map, figures.effects))
    figures.map = heat_map(tried, figures.effects, axes->first, axes->second);
  return figures;
}

/// Or all, where none is: one that lacks a case would tell the cases apart in place of the values.
std::vector<TalliedSetting> complete_ones(std::vector<TalliedSetting> settings) {
  const auto is_complete = [](const TalliedSetting& setting) { return setting.result.complete; };
  if (std::ranges::any_of(settings, is_complete)) std::erase_if(settings, std::not_fn(is_complete));
  return settings;
}

bool are_times_comparable(const std::vector<NamedRun>& runs) {
  return std::none_of(runs.begin(), runs.end(),
                      [&](const NamedRun& run) { return why_times_differ(run, runs.front()).has_value(); });
}

void note_parts(const std::vector<SweepRun>& runs, SweepAnalysis& analysis) {
  const auto note = [](const auto& value, auto& list) {
    if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
  };
  for (const SweepRun& run : runs) {
    if (run.part.role == CaseRole::choose) note(run.part.case_name, analysis.choose_on);
    if (run.part.role == CaseRole::judge) note(run.part.case_name, analysis.judge_on);
    note(run.part.seed, analysis.seeds);
    if (!run.complete) analysis.incomplete.push_back(run.name);
  }
  for (auto* list : {&analysis.choose_on, &analysis.judge_on}) std::sort(list->begin(), list->end());
  std::sort(analysis.seeds.begin(), analysis.seeds.end());
}

}  // namespace

SweepAnalysis analyse_sweep(const std::vector<NamedRun>& runs, const MapChoice& map,
                            const std::string& baseline) {
  const std::vector<SweepRun> parts = sweep_of(runs);
  SweepAnalysis analysis;
  analysis.experiment = runs.front().results.experiment;
  analysis.runs = runs.size();
  note_parts(parts, analysis);
  const std::vector<TalliedSetting> settings = settings_of(parts, false);
  if (!baseline.empty()) check_setting(baseline, settings);
  for (const TalliedSetting& setting : settings) analysis.settings.push_back(setting.result);
  std::stable_sort(analysis.settings.begin(), analysis.settings.end(), is_better);
  analysis.parameters = figures_of(complete_ones(settings), map);
  compare_settings(runs, settings, baseline, analysis);
  return analysis;
}

std::optional<ParameterFigures> compare_parameters(const std::vector<NamedRun>& runs, bool with_times) {
  if (!is_sweep(runs)) return std::nullopt;
  const std::vector<Method> methods = methods_of(runs);
  const PairedTrials paired = pair_trials(runs, methods);
  std::vector<std::map<TrialStart, TrialResult>> shared(runs.size());
  for (std::size_t t = 0; t < paired.trials.size(); ++t) {
    const auto& [cell, start] = paired.trials[t];
    for (std::size_t m = 0; m < methods.size(); ++m)
      shared[paired.cells[cell].runs[m]].emplace(start, *paired.results[m][t]);
  }
  std::vector<SweepRun> parts = sweep_of(runs);
  for (SweepRun& part : parts) {
    part.trials = &shared[part.index];
    std::erase_if(part.part.values, [](const auto& value) { return value.first == "method"; });
  }
  ParameterFigures figures = figures_of(settings_of(parts, with_times && are_times_comparable(runs)), {});
  if (figures.effects.empty() || figures.effects.size() > most_compared_parameters) return std::nullopt;
  return figures;
}

}  // namespace glocal
