// Runs on the same starts, compared with one of them.
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
  const char* unit;   ///< Of the values; empty for counts.
  const char* label;  ///< In sentences.
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

/// Differences of values this near are rounding, as a share of the values.
inline constexpr double rounding = 1e-9;

/// One run over the shared starts.
struct RunFigures {
  std::string name;
  std::string folder, experiment;
  std::uint64_t seed = 0;
  std::size_t right = 0, wrong = 0;
  std::size_t undecided = 0;  ///< With failed trials, and those without a reference to judge by.
  Proportion success{}, false_rate{};
  std::vector<std::optional<double>> medians = {};  ///< In the order of Comparison::measured.
};

/// A difference, variant less baseline, with its 95 % interval by the bootstrap over starts.
struct Difference {
  double value = 0.0;
  Interval interval;
};

/// Right and not right, or wrong and not wrong.
struct OutcomeDifference {
  const char* name = "";
  bool more_is_better = true;
  PairedCounts counts{};       ///< Baseline first, variant second.
  Difference points{};         ///< Percentage points.
  Interval newcombe_points{};  ///< The interval after Newcombe (1998).
  double p = 1.0;              ///< McNemar, exact.
  double p_holm = 1.0;
};

/// A measure over the starts at which both runs have it.
struct MeasureDifference {
  Measure measure{};
  std::size_t starts = 0;
  double baseline_median = 0.0, variant_median = 0.0;
  Difference median, mean;  ///< Of the differences at each start.
  SignedRank test;
  ShiftEstimate shift;    ///< What the test is about.
  double smallest = 0.0;  ///< Difference that matters, as the values are.
  double p_holm = 1.0;

  [[nodiscard]] bool matters() const { return std::abs(shift.value) >= smallest; }
};

/// A variant and the baseline.
struct PairComparison {
  std::string variant;
  std::span<const Measure> measured = {};  ///< Those that tell of the runs, and not of the machine.
  std::vector<OutcomeDifference> outcomes;
  std::vector<MeasureDifference> measures;  ///< Those with at least one start.
  std::string conclusion;                   ///< One sentence.
  std::vector<std::string> warnings;        ///< What these numbers cannot tell.
};

struct Comparison {
  std::string baseline;
  std::size_t starts = 0;  ///< That all runs have.
  std::span<const Measure> measured;
  std::vector<RunFigures> runs;
  std::vector<PairComparison> pairs;  ///< Every other run with the baseline.
  std::vector<std::string> warnings;  ///< What makes the runs hard to compare.
  /// Holm's families: all tests of outcomes, and all tests of measures.
  std::size_t outcome_tests = 0, measure_tests = 0;
};

/// What Holm's p must be below for a difference to be called significant.
inline constexpr double significance = 0.05;

/// The starts that all of these runs have. Throws ConfigError if there are none.
[[nodiscard]] std::vector<TrialStart> shared_starts(const std::vector<NamedRun>& runs);

/// Compares runs, of which `baseline` is an index, over their shared_starts(), and throws what it throws.
/// The same runs give the same comparison.
[[nodiscard]] Comparison compare(const std::vector<NamedRun>& runs, std::size_t baseline,
                                 std::span<const Measure> measured = measures());

}  // namespace glocal
