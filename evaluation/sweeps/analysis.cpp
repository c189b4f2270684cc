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
#include "glocal/error.hpp"

namespace glocal {
namespace {

/// A trial that other settings have, too: case, seed and start.
using SharedStart = std::tuple<std::string, std::uint64_t, TrialStart>;

/// The trials of a setting in the runs of one purpose.
class Tally {
 public:
  void add(const SweepRun& run) {
    for (const auto& [start, trial] : *run.trials) {
      const bool is_right = trial.outcome == Outcome::right;
      const bool is_wrong = trial.outcome == Outcome::wrong;
      const TrialPlace place{run.case_name, start.sample};
      add_trials({{place, {is_right ? 1U : 0U, 1}}}, right_);
      add_trials({{place, {is_wrong ? 1U : 0U, 1}}}, wrong_);
      if (is_right) steps_.push_back(trial.steps);
      if (trial.step_cpu_ms) step_cpu_ms_.push_back(*trial.step_cpu_ms);
      scores_[{run.case_name, run.seed, start}] = is_right ? 1 : is_wrong ? -1 : 0;
    }
  }

  [[nodiscard]] SettingOutcome outcome() const {
    SettingOutcome outcome;
    outcome.trials = scores_.size();
    for (const auto& [start, score] : scores_) {
      outcome.right += score > 0 ? 1 : 0;
      outcome.wrong += score < 0 ? 1 : 0;
    }
    outcome.success = success_of(right_);
    outcome.false_rate = success_of(wrong_);
    outcome.median_steps = median_if_any(steps_);
    return outcome;
  }

  /// With what is known of its setting.
  [[nodiscard]] TriedSetting tried(const SettingResult& setting, bool with_times) const {
    return {.values = setting.values,
            .trials = right_,
            .wrong = setting.chosen.wrong,
            .steps = steps_,
            .step_cpu_ms = with_times ? step_cpu_ms_ : std::vector<double>()};
  }
  [[nodiscard]] const std::map<SharedStart, int>& scores() const { return scores_; }

 private:
  TrialsByPlace right_, wrong_;  ///< Successes are right trials, and wrong ones.
  std::vector<double> steps_, step_cpu_ms_;
  std::map<SharedStart, int> scores_;
};

struct TalliedSetting {
  SettingResult result;
  Tally chosen, judged;
  std::set<std::pair<std::string, std::uint64_t>> runs;  ///< Cases and seeds.
};

/// In the order of their first run.
std::vector<TalliedSetting> settings_of(const std::vector<SweepRun>& runs) {
  std::vector<TalliedSetting> settings;
  std::map<std::string, std::size_t> numbers;
  std::set<std::pair<std::string, std::uint64_t>> all;
  for (const SweepRun& run : runs) {
    const auto [number, is_new] = numbers.try_emplace(run.setting, settings.size());
    if (is_new) {
      settings.emplace_back();
      settings.back().result.name = run.setting;
      settings.back().result.values = run.values;
    }
    TalliedSetting& setting = settings[number->second];
    (run.role == CaseRole::judge ? setting.judged : setting.chosen).add(run);
    setting.runs.emplace(run.case_name, run.seed);
    all.emplace(run.case_name, run.seed);
    setting.result.complete = setting.result.complete && run.complete;
  }
  for (TalliedSetting& setting : settings) {
    setting.result.complete = setting.result.complete && setting.runs == all;
    setting.result.chosen = setting.chosen.outcome();
    if (!setting.judged.scores().empty()) setting.result.judged = setting.judged.outcome();
  }
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

/// Of all complete settings, over the trials that all of them have.
std::optional<ChanceOfBest> chance_among(const std::vector<TalliedSetting>& settings) {
  std::vector<const TalliedSetting*> complete;
  for (const TalliedSetting& setting : settings) {
    if (setting.result.complete) complete.push_back(&setting);
  }
  if (complete.empty()) return std::nullopt;
  std::map<TrialPlace, ScoresAtPlace> places;
  std::size_t trials = 0;
  for (const auto& [start, first] : complete.front()->chosen.scores()) {
    ScoresAtPlace scores;
    for (const TalliedSetting* setting : complete) {
      const auto score = setting->chosen.scores().find(start);
      if (score != setting->chosen.scores().end()) scores.push_back(score->second);
    }
    if (scores.size() < complete.size()) continue;
    ++trials;
    const auto& [case_name, seed, at] = start;
    ScoresAtPlace& sum = places[{case_name, at.sample}];
    sum.resize(scores.size());
    std::transform(sum.begin(), sum.end(), scores.begin(), sum.begin(), std::plus<>());
  }
  std::vector<ScoresAtPlace> all;
  for (auto& [place, scores] : places) all.push_back(std::move(scores));
  return chance_of_best(all, trials);
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
    throw ConfigError({{"--map " + name, 0, 0, "more than one parameter ends so; name its whole path"}});
  throw ConfigError(
      {{"--map " + name, 0, 0, "no such parameter varies" + suggestion(name, paths, "there are")}});
}

std::optional<std::pair<std::size_t, std::size_t>> chosen_axes(const MapChoice& choice,
                                                               const std::vector<ParameterEffect>& effects) {
  if (!choice)
    return effects.size() < 2 ? std::nullopt : std::optional(std::pair<std::size_t, std::size_t>(0, 1));
  const std::pair axes(number_of_parameter(choice->first, effects),
                       number_of_parameter(choice->second, effects));
  if (axes.first == axes.second)
    throw ConfigError({{fmt::format("--map {} {}", choice->first, choice->second), 0, 0,
                        "is one parameter twice; name two"}});
  return axes;
}

ParameterFigures figures_of(const std::vector<TalliedSetting>& settings, const MapChoice& map,
                            bool with_times) {
  std::vector<TriedSetting> tried;
  for (const TalliedSetting& setting : settings)
    tried.push_back(setting.chosen.tried(setting.result, with_times));
  ParameterFigures figures{effects_of(tried), {}};
  if (const auto axes = chosen_axes(map, figures.effects))
    figures.map = heat_map(tried, figures.effects, axes->first, axes->second);
  return figures;
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
    if (run.role == CaseRole::choose) note(run.case_name, analysis.choose_on);
    if (run.role == CaseRole::judge) note(run.case_name, analysis.judge_on);
    note(run.seed, analysis.seeds);
    if (!run.complete) analysis.incomplete.push_back(run.name);
  }
  for (auto* list : {&analysis.choose_on, &analysis.judge_on}) std::sort(list->begin(), list->end());
  std::sort(analysis.seeds.begin(), analysis.seeds.end());
}

}  // namespace

SweepAnalysis analyse_sweep(const std::vector<NamedRun>& runs, const MapChoice& map) {
  const std::vector<SweepRun> parts = sweep_of(runs);
  SweepAnalysis analysis;
  analysis.experiment = runs.front().results.experiment;
  analysis.runs = runs.size();
  note_parts(parts, analysis);
  const std::vector<TalliedSetting> settings = settings_of(parts);
  for (const TalliedSetting& setting : settings) analysis.settings.push_back(setting.result);
  std::stable_sort(analysis.settings.begin(), analysis.settings.end(), is_better);
  analysis.parameters = figures_of(settings, map, false);
  analysis.chance = chance_among(settings);
  return analysis;
}

std::optional<ParameterFigures> compare_parameters(const std::vector<NamedRun>& runs, bool with_times) {
  if (!is_sweep(runs)) return std::nullopt;
  std::vector<SweepRun> parts = sweep_of(runs);
  std::vector<std::map<TrialStart, TrialResult>> shared(parts.size());
  for (const TrialStart& start : shared_starts(runs)) {
    for (std::size_t i = 0; i < parts.size(); ++i) shared[i].emplace(start, parts[i].trials->at(start));
  }
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].trials = &shared[i];
  ParameterFigures figures = figures_of(settings_of(parts), {}, with_times && are_times_comparable(runs));
  if (figures.effects.empty() || figures.effects.size() > most_compared_parameters) return std::nullopt;
  return figures;
}

}  // namespace glocal
