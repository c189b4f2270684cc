// What each parameter of a sweep does by itself, over all else that varies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/results/results_folder.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "evaluation/sweeps/setting_values.hpp"

namespace glocal {

/// How the trials of a setting ended, over all its seeds and some of the cases; or those of some settings, as
/// the mean over all in which these differ.
struct SettingOutcome {
  std::size_t settings = 0;                       ///< Added as such, not trial by trial.
  std::size_t trials = 0, right = 0, wrong = 0;   ///< All others count as undecided.
  std::size_t failed = 0, declared = 0;           ///< Of these: with an exception; without a reference.
  Proportion success{}, false_rate{};             ///< Trials at one place of a drive are not independent.
  std::optional<double> median_steps = {};        ///< To localize; none where no trial was right.
  std::optional<double> median_step_cpu_ms = {};  ///< CPU time of a step; none where it is not to be told.

  /// Success rate less false rate, by which settings are ranked: a wrong answer undoes a right one.
  [[nodiscard]] double score() const { return success.value - false_rate.value; }
};

/// Counts the trials of a setting, or those of some settings.
class Tally {
 public:
  /// The trials of a run.
  void add(const std::string& case_name, const std::map<TrialStart, TrialResult>& trials, bool with_times);
  void add(const Tally& setting);
  [[nodiscard]] SettingOutcome outcome() const;

 private:
  struct Ends {
    std::size_t trials = 0, right = 0, wrong = 0, failed = 0, declared = 0;
  };
  std::size_t settings_ = 0;
  /// By case and sample: trials that start there, with any seed, tend to end alike.
  std::map<std::pair<std::string, std::int64_t>, Ends> places_;
  std::vector<double> steps_;        ///< To localize, of right trials.
  std::vector<double> step_cpu_ms_;  ///< Of trials; empty where times are not to be told.
};

/// What the effect of parameters is computed from.
struct TriedSetting {
  SettingValues values;
  Tally trials;
};

/// The settings with one value of a parameter, or with values in one range.
struct ParameterLevel {
  std::string label;
  SettingOutcome outcome = {};
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
  std::size_t row = 0, column = 0;                 ///< Numbers of the effects.
  std::vector<std::vector<SettingOutcome>> cells;  ///< A list for each level of the row's parameter.
};
[[nodiscard]] HeatMap heat_map(const std::vector<TriedSetting>& settings,
                               const std::vector<ParameterEffect>& effects, std::size_t row,
                               std::size_t column);

}  // namespace glocal
