// Methods on the same starts, compared with one of them.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/results/results_folder.hpp"
#include "evaluation/statistics/hypothesis_tests.hpp"
#include "evaluation/statistics/paired_intervals.hpp"
#include "evaluation/statistics/statistics.hpp"

namespace glocal {

/// A run with the name it goes by in a comparison.
struct NamedRun {
  std::string name;
  StoredRun results;
};

/// What is measured of a trial besides its outcome. Less is better.
struct Measure {
  const char* name;
  const char* unit;    ///< Of the values; empty for counts.
  const char* label;   ///< In sentences.
  const char* column;  ///< Above a column.
  /// Differences below it matter to nobody, however sure they are: as the values are, or as a share of the
  /// baseline's median.
  double smallest;
  bool is_share;
  /// None where the trial has no such value: all but the time are of right trials.
  std::optional<double> (*of)(const TrialResult&);
};
[[nodiscard]] std::span<const Measure> measures();
/// Those that are the same for runs with the same seed.
[[nodiscard]] std::span<const Measure> measures_but_time();
/// Whether times are among these.
[[nodiscard]] bool has_time(std::span<const Measure> measured);

/// Differences of values this near are rounding, as a share of the values.
inline constexpr double rounding = 1e-9;

/// A difference, variant less baseline, with its 95 % interval.
struct Difference {
  double value = 0.0;
  Interval interval;
};

/// How trials of a method ended. Undecided are all that are neither right nor wrong: failed ones, and those
/// without a reference to judge by, too.
struct OutcomeCounts {
  std::size_t right = 0, wrong = 0, undecided = 0;
};

/// A method in one case.
struct CaseFigures {
  OutcomeCounts outcomes;
  std::optional<double> median_steps;
  std::optional<Difference> right_points, wrong_points;  ///< Not of the baseline itself.
};

/// One method over the shared trials.
struct MethodFigures {
  std::string name;
  std::string experiment;
  std::vector<std::string> folders;  ///< Of the runs that count.
  OutcomeCounts outcomes;
  Proportion success{}, false_rate{}, undecided_rate{};  ///< Trials at one place are not independent.
  std::vector<std::optional<double>> medians = {};       ///< In the order of Comparison::measured.
  std::vector<CaseFigures> cases = {};                   ///< In the order of Comparison::cases.
};

/// Trials by which of two methods have a property.
struct PairedCounts {
  std::size_t both = 0, only_baseline = 0, only_variant = 0, neither = 0;
};

/// What Holm's p must be below for a difference to be called significant.
inline constexpr double significance = 0.05;

/// A test of one difference in its family.
struct TestResult {
  std::size_t differing = 0;  ///< Places at which the two differ.
  double p = 1.0;
  double p_holm = 1.0;

  /// Whether so many places could have been significant at all. Other tests are no part of their family.
  [[nodiscard]] bool has_chance() const { return least_p(differing) < significance; }
  [[nodiscard]] bool is_significant() const { return p_holm < significance; }
};

/// Right and not right, or wrong and not wrong.
struct OutcomeDifference {
  const char* name = "";
  bool more_is_better = true;
  double smallest = 0.0;  ///< Difference that matters, percentage points.
  PairedCounts counts{};
  std::size_t places = 0;
  std::size_t places_more = 0, places_less = 0;  ///< At which the variant has it in more trials, or fewer.
  Difference points{};                           ///< Percentage points.
  TestResult test{};
  double places_needed = 0.0;  ///< To find a difference that matters (places_to_find()).

  [[nodiscard]] bool matters() const { return std::abs(points.value) >= smallest; }
};

/// A measure over the trials at which both methods have it.
struct MeasureDifference {
  Measure measure{};
  std::size_t places = 0, trials = 0;
  double baseline_median = 0.0, variant_median = 0.0;
  Difference mean;      ///< Of the differences of all these trials …
  double median = 0.0;  ///< … and their median.
  std::size_t trials_that_differ = 0;
  double mean_of_those = 0.0;
  SignedRank ranks;  ///< Of the mean differences of places.
  TestResult test{};
  double smallest = 0.0;  ///< Difference that matters, as the values are.
  double places_needed = 0.0;

  /// Whether ranks and mean agree on who has less.
  [[nodiscard]] bool ranks_agree() const {
    return (ranks.positive_sum < ranks.expected_sum) == (mean.value < 0.0);
  }
  /// It is as large as what matters, and ranks and mean agree.
  [[nodiscard]] bool matters() const { return ranks_agree() && std::abs(mean.value) >= smallest; }
};

/// A variant and the baseline.
struct PairComparison {
  std::string variant;
  std::span<const Measure> measured = {};
  std::vector<OutcomeDifference> outcomes;  ///< Wrong, then right: the first matters most.
  std::vector<MeasureDifference> measures;  ///< Those with at least two places.
  std::string conclusion;                   ///< In what it is better or worse, or what it takes to tell.
  std::vector<std::string> warnings;        ///< What these numbers cannot tell.
};

struct Comparison {
  std::string baseline;
  std::size_t starts = 0;  ///< Trials of each method: starts of all places, cases and seeds.
  std::size_t places = 0;
  std::vector<std::string> cases;    ///< A single one without a name for runs without cases.
  std::vector<std::uint64_t> seeds;  ///< Within which trials are paired.
  std::span<const Measure> measured;
  std::vector<MethodFigures> methods;
  std::vector<PairComparison> pairs;  ///< Every other method with the baseline.
  std::vector<std::string> warnings;  ///< What makes the runs hard to compare.
  /// Holm's families: tests of outcomes, and tests of measures, as far as they have a chance.
  std::size_t outcome_tests = 0, measure_tests = 0;
};

/// Groups runs into methods and compares these, over the trials that all have, with the method that the run
/// with the index `baseline` is of. Throws ConfigError where there are no such trials, or no two methods. The
/// same runs give the same comparison.
[[nodiscard]] Comparison compare(const std::vector<NamedRun>& runs, std::size_t baseline,
                                 std::span<const Measure> measured = measures());

}  // namespace glocal
