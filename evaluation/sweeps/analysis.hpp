// What is learned from a sweep: which settings are good, which parameters matter, and how much of it may be
// chance.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/sweeps/effects.hpp"
#include "evaluation/sweeps/leads.hpp"
#include "evaluation/sweeps/setting_values.hpp"
#include "evaluation/sweeps/sweep.hpp"

namespace glocal {

struct SettingResult {
  std::string name;
  SettingValues values;                  ///< As comparable_values() has them.
  bool complete = true;                  ///< It has all cases and seeds that any setting has, to their ends.
  SettingOutcome chosen;                 ///< Over the cases of choose_on; without cases over all runs.
  std::optional<SettingOutcome> judged;  ///< Over the cases of judge_on.
  std::optional<Lead> over_baseline;     ///< By the trials that all complete settings have; not of itself.
};

/// What of the lead of the best setting may be chance.
struct ChanceOfBest {
  std::size_t places = 0, trials = 0;  ///< That all complete settings have.
  std::string baseline, second;        ///< The second best of the complete settings.
  Lead over_second;
  double score_of_second = 0.0;  ///< A share; nobody can be ahead of it by more than what is left of 1.
};

/// What each parameter does, and the map of two of them.
struct ParameterFigures {
  std::vector<ParameterEffect> effects;  ///< Of `chosen`; the largest first.
  std::optional<HeatMap> map;            ///< None with fewer than two parameters.
};

struct SweepAnalysis {
  std::string experiment;
  std::size_t runs = 0;
  std::vector<std::string> choose_on, judge_on;  ///< Names of cases.
  std::vector<std::uint64_t> seeds;
  std::vector<SettingResult> settings;  ///< Best first; incomplete ones behind all others.
  std::vector<std::string> incomplete;  ///< Names of runs without all their trials.
  ParameterFigures parameters;
  std::optional<ChanceOfBest> chance;  ///< None without two complete settings that share trials.
  std::string why_not_compared;        ///< Though there are two complete settings; else empty.
};

/// Which parameters to show in the map, by their paths, or by ends of these that no other one has; without,
/// those of the largest effect.
using MapChoice = std::optional<std::pair<std::string, std::string>>;

/// Settings are ranked by their score, then by fewer median steps, then in the order of their first runs.
/// They are compared with the setting named `baseline`; without a name with the first one that is complete.
/// Throws ConfigError for runs that are no sweep, and for settings and parameters that are none.
[[nodiscard]] SweepAnalysis analyse_sweep(const std::vector<NamedRun>& runs, const MapChoice& map = {},
                                          const std::string& baseline = "");

/// With more parameters than these a comparison of runs does not tell what each of them does.
inline constexpr std::size_t most_compared_parameters = 2;

/// What the parameters do in which runs that are compared differ, over the trials that all of them have. None
/// where the runs are no sweep, or one of too many parameters; the method does not count as one. Times are
/// told where they can be compared.
[[nodiscard]] std::optional<ParameterFigures> compare_parameters(const std::vector<NamedRun>& runs,
                                                                 bool with_times);

}  // namespace glocal
