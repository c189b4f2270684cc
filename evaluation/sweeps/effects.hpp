// What each parameter of a sweep does by itself, over all else that varies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/statistics/statistics.hpp"

namespace glocal {

/// A place on a drive of a case: trials that start there, with any seed, tend to end alike.
using TrialPlace = std::pair<std::string, std::int64_t>;
using TrialsByPlace = std::map<TrialPlace, TrialCluster>;

/// Adds the trials of one setting, or of several, to those of others.
void add_trials(const TrialsByPlace& trials, TrialsByPlace& sum);
/// The share of right ones among all, with its 95 % interval (wilson_of_clusters()).
[[nodiscard]] Proportion success_of(const TrialsByPlace& trials);
[[nodiscard]] std::size_t count_trials(const TrialsByPlace& trials);

/// What the effect of parameters is computed from.
struct TriedSetting {
  std::vector<std::pair<std::string, std::string>> values;  ///< Paths and values, as written.
  TrialsByPlace trials;                                     ///< Successes are right trials.
  std::size_t wrong = 0;
  std::vector<double> steps = {};        ///< To localize, of right trials.
  std::vector<double> step_cpu_ms = {};  ///< Of trials; empty where times are not to be told.
};

/// How the trials of some settings ended: the mean over all in which these differ.
struct GroupOutcome {
  std::size_t settings = 0, trials = 0, wrong = 0;
  Proportion success{};
  std::optional<double> median_steps = {};        ///< To localize; none where no trial was right.
  std::optional<double> median_step_cpu_ms = {};  ///< CPU time of a step; none where it is not to be told.
};

/// The settings with one value of a parameter, or with values in one range.
struct ParameterLevel {
  std::string label;
  GroupOutcome outcome = {};
};

struct ParameterEffect {
  std::string path;
  std::string label;       ///< The end of the path, as far as it tells this parameter from the others.
  bool is_binned = false;  ///< Levels are quarters of the values, not single ones.
  std::vector<ParameterLevel> levels =
      {};              ///< At least two; numbers rise, other values are in their first order.
  double range = 0.0;  ///< Of the success of the levels: the largest less the smallest.
  std::optional<double> spearman = {};  ///< Of numbers: rank correlation of value and success over settings.
  std::vector<std::optional<std::size_t>> level_of =
      {};  ///< For each setting; none where it leaves the value alone.
};

/// Numbers of more different values than this are shown in quarters.
inline constexpr std::size_t most_single_values = 6;

/// The effects of all parameters that have several values, the largest first.
[[nodiscard]] std::vector<ParameterEffect> effects_of(const std::vector<TriedSetting>& settings);

/// The settings with one level of each of two parameters.
struct HeatMap {
  std::size_t row = 0, column = 0;               ///< Numbers of the effects.
  std::vector<std::vector<GroupOutcome>> cells;  ///< A list for each level of the row's parameter.
};
[[nodiscard]] HeatMap heat_map(const std::vector<TriedSetting>& settings,
                               const std::vector<ParameterEffect>& effects, std::size_t row,
                               std::size_t column);

}  // namespace glocal
