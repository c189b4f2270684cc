#include "evaluation/comparison/comparison.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluation/comparison/comparison_report.hpp"
#include "evaluation/comparison/runs.hpp"
#include "glocal/error.hpp"

namespace glocal::test::comparison_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Comparison, CountsOutcomesStartByStart) {
  const Comparison comparison = compare(slow_and_quick(), 0);
  EXPECT_EQ(comparison.baseline, "slow");
  EXPECT_EQ(comparison.starts, 30U);
  ASSERT_EQ(comparison.pairs.size(), 1U);
  ASSERT_EQ(comparison.pairs.front().outcomes.size(), 2U);
  const OutcomeDifference& right = comparison.pairs.front().outcomes[0];
  EXPECT_EQ(right.counts.both, 20U);
  EXPECT_EQ(right.counts.only_first, 1U);
  EXPECT_EQ(right.counts.only_second, 9U);
  EXPECT_EQ(right.counts.neither, 0U);
  EXPECT_NEAR(right.points.value, 100.0 * 8.0 / 30.0, 1e-9);
  EXPECT_LT(right.points.interval.low, right.points.value);
  EXPECT_GT(right.points.interval.high, right.points.value);
  EXPECT_DOUBLE_EQ(right.p, 2.0 * 11.0 / 1024.0);  // (C(10,0) + C(10,1)) / 2^10, twice
  const OutcomeDifference& wrong = comparison.pairs.front().outcomes[1];
  EXPECT_EQ(wrong.counts.only_first, 9U);
  EXPECT_EQ(wrong.counts.only_second, 0U);
  EXPECT_DOUBLE_EQ(wrong.p, 2.0 / 512.0);
}

TEST(Comparison, SumsUpEachRun) {
  const Comparison comparison = compare(slow_and_quick(), 0);
  ASSERT_EQ(comparison.runs.size(), 2U);
  const RunFigures& slow = comparison.runs[0];
  EXPECT_EQ(slow.right, 21U);
  EXPECT_EQ(slow.wrong, 9U);
  EXPECT_EQ(slow.undecided, 0U);
  EXPECT_DOUBLE_EQ(slow.success.value, 0.7);
  EXPECT_EQ(comparison.runs[1].undecided, 1U);
  // Steps of right trials: 9 to 29. Times of all: 18, 20 to 58 by 2, and nine of 5: the median of 30 is
  // between the 15th (28, after nine of 5 and 18, 20, 22, 24, 26) and the 16th (30).
  EXPECT_EQ(slow.medians[0], 19.0);
  EXPECT_EQ(slow.medians[4], 29.0);
}

TEST(Comparison, ComparesMeasuresWhereBothAreRight) {
  const PairComparison pair = compare(slow_and_quick(), 0).pairs.front();
  ASSERT_EQ(pair.measures.size(), 5U);
  const MeasureDifference& steps = pair.measures[0];
  EXPECT_STREQ(steps.measure.name, "steps");
  EXPECT_EQ(steps.starts, 20U);
  EXPECT_EQ(steps.baseline_median, 19.5);
  EXPECT_EQ(steps.variant_median, 17.5);
  EXPECT_EQ(steps.median.value, -2.0);
  EXPECT_EQ(steps.median.interval.low, -2.0);
  EXPECT_EQ(steps.mean.value, -2.0);
  EXPECT_DOUBLE_EQ(steps.test.p, std::exp2(-19.0));  // all 20 of one sign
  EXPECT_EQ(pair.measures[1].median.value, -1.0);    // m
  const MeasureDifference& time = pair.measures[4];
  EXPECT_STREQ(time.measure.name, "step_cpu_ms");
  EXPECT_EQ(time.starts, 30U);
}

TEST(Comparison, CorrectsInTwoFamilies) {
  std::vector<NamedRun> runs = slow_and_quick();
  runs.push_back(run_of("same", std::vector<TrialResult>()));
  runs[2].results.trials = runs[0].results.trials;
  const Comparison comparison = compare(runs, 0);
  EXPECT_EQ(comparison.outcome_tests, 4U);
  EXPECT_EQ(comparison.measure_tests, 10U);
  const PairComparison& quick = comparison.pairs[0];
  // Smallest of four, then of three.
  EXPECT_DOUBLE_EQ(quick.outcomes[1].p_holm, 4.0 * 2.0 / 512.0);
  EXPECT_DOUBLE_EQ(quick.outcomes[0].p_holm, 3.0 * 22.0 / 1024.0);
  EXPECT_EQ(comparison.pairs[1].outcomes[0].p_holm, 1.0);
}

TEST(Comparison, SaysWhoIsBetterInWhat) {
  const PairComparison quick = compare(slow_and_quick(), 0).pairs.front();
  EXPECT_THAT(quick.conclusion,
              AllOf(HasSubstr("quick is significantly better than slow in right (+26.7 points, p = 0.021), "
                              "wrong (-30.0 points, p = 0.008), steps to localize (-2, p < 0.001)"),
                    HasSubstr("translation error (-0.02 m, p < 0.001)")));
  const PairComparison slow = compare(slow_and_quick(), 1).pairs.front();
  EXPECT_THAT(slow.conclusion,
              HasSubstr("slow is significantly worse than quick in right (-26.7 points, p = 0.021)"));
}

TEST(Comparison, SaysThatNothingCanBeTold) {
  // 5 pairs that all differ the same way: p is 0.0625.
  std::vector<TrialResult> first(25, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 5; ++i) {
    second[i] = ended(Outcome::wrong);
    second[i].step_cpu_ms = first[i].step_cpu_ms;
  }
  for (std::size_t i = 5; i < 8; ++i) second[i] = right_after(9.0);
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  EXPECT_DOUBLE_EQ(pair.outcomes[0].p, 0.0625);
  EXPECT_EQ(pair.conclusion,
            "Nothing can be told between b and a: no difference over 25 starts is significant.");
  EXPECT_THAT(pair.warnings, ElementsAre(AllOf(HasSubstr("fewer than 6"), HasSubstr("right (5), wrong (5), "),
                                               HasSubstr("steps to localize (3)"))));
}

TEST(Comparison, LeavesOutMeasuresThatNoStartHas) {
  std::vector<TrialResult> never(25, ended(Outcome::undecided));
  for (TrialResult& trial : never) trial.step_cpu_ms.reset();
  const Comparison comparison =
      compare({run_of("a", std::vector<TrialResult>(25, right_after(10.0))), run_of("never", never)}, 0);
  EXPECT_THAT(comparison.pairs.front().measures, IsEmpty());
  EXPECT_EQ(comparison.runs[1].medians[0], std::nullopt);
  EXPECT_EQ(comparison.measure_tests, 0U);
  EXPECT_THAT(
      comparison.pairs.front().warnings,
      Contains(HasSubstr("no start at which both have a value for steps to localize, way to localize")));
}

TEST(Comparison, SaysNothingOfMeasuresThatAreNotAskedFor) {
  std::vector<NamedRun> runs = slow_and_quick();
  EXPECT_EQ(compare(runs, 0, measures_but_time()).measure_tests, 4U);
  for (NamedRun& run : runs) {
    for (auto& [start, trial] : run.results.trials) trial.step_cpu_ms.reset();
  }
  const Comparison all = compare(runs, 0);
  const Comparison some = compare(runs, 0, measures_but_time());
  EXPECT_EQ(all.runs[0].medians.size(), 5U);
  EXPECT_EQ(some.runs[0].medians.size(), 4U);
  EXPECT_THAT(all.pairs.front().warnings,
              ElementsAre(HasSubstr("both have a value for CPU time of a step.")));
  EXPECT_THAT(some.pairs.front().warnings, IsEmpty());
  EXPECT_THAT(as_text(comparison_report(all)), HasSubstr("CPU time of a step, ms"));
  EXPECT_THAT(as_text(comparison_report(some)), Not(HasSubstr("CPU time of a step, ms")));
}

TEST(Comparison, TellsWhatTheTestIsAbout) {
  // 30 starts; at 12 of them the variant takes 4 steps fewer, elsewhere as many.
  std::vector<TrialResult> first(30, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 12; ++i) second[i] = right_after(6.0);
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  EXPECT_EQ(pair.measures[0].median.value, 0.0);
  EXPECT_THAT(pair.conclusion, HasSubstr("steps to localize (-4, p = 0.002)"));
  EXPECT_EQ(pair.measures[0].shift.value, -4.0);
}

TEST(Comparison, CallsSureDifferencesThatMatterToNobodyByTheirName) {
  // 30 starts; the error is a millimetre less at each, the time 6 % more.
  std::vector<TrialResult> first, second;
  for (int i = 0; i < 30; ++i) {
    first.push_back(right_after(10.0 + i));
    second.push_back(first.back());
    *second.back().translation_error_m -= 0.001;
    *second.back().step_cpu_ms *= 1.06;
  }
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  EXPECT_FALSE(pair.measures[2].matters());
  EXPECT_LT(pair.measures[2].p_holm, 0.001);
  EXPECT_TRUE(pair.measures[4].matters());
  // 5 % of the median, 49 ms.
  EXPECT_DOUBLE_EQ(pair.measures[4].smallest, 0.05 * 49.0);
  EXPECT_THAT(pair.conclusion, AllOf(HasSubstr("b is significantly worse than a in CPU time of a step (+2.9"),
                                     HasSubstr("No difference that matters: translation error (-0.001 m")));
  for (TrialResult& trial : second) trial.step_cpu_ms.reset();
  EXPECT_THAT(compare({run_of("a", first), run_of("b", second)}, 0).pairs.front().conclusion,
              HasSubstr("Nothing that matters differs between b and a"));
}

TEST(Comparison, TakesRoundingForNoDifference) {
  std::vector<TrialResult> first(30, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (TrialResult& trial : second) trial.distance_m += 1.78e-15;
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  EXPECT_EQ(pair.measures[1].test.nonzero, 0U);
  EXPECT_EQ(pair.measures[1].mean.value, 0.0);
}

TEST(Comparison, TestsNoTimesThatTellOfTheMachine) {
  std::vector<NamedRun> runs = slow_and_quick();
  EXPECT_EQ(compare(runs, 0).measure_tests, 5U);
  runs[1].results.machine.jobs = 2;
  const Comparison comparison = compare(runs, 0);
  EXPECT_EQ(comparison.measure_tests, 4U);
  EXPECT_EQ(comparison.runs[1].medians.size(), 5U);
  EXPECT_THAT(comparison.warnings, Contains(HasSubstr("--jobs 2, and --jobs 1")));
  EXPECT_THAT(comparison.pairs.front().warnings, IsEmpty());
}

TEST(Comparison, TakesOnlyStartsThatAllHave) {
  std::vector<NamedRun> runs = slow_and_quick();
  runs[0].results.trials.erase(runs[0].results.trials.begin());
  runs[1].results.trials.erase(std::prev(runs[1].results.trials.end()));
  const Comparison comparison = compare(runs, 0);
  EXPECT_EQ(comparison.starts, 28U);
  EXPECT_EQ(comparison.pairs.front().outcomes[0].counts.both, 19U);
  EXPECT_THAT(
      comparison.warnings,
      Contains("Only the 28 starts that all runs have are compared. Left out: 1 of slow, 1 of quick."));
}

TEST(Comparison, RefusesRunsWithoutACommonStart) {
  std::vector<NamedRun> runs = slow_and_quick();
  const TrialResult trial = right_after(3.0);
  runs[1].results.trials = {{{0, 0.5, 1000.0}, trial}};
  try {
    static_cast<void>(compare(runs, 0));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("results/slow: error: none of its 30 starts"),
                                    HasSubstr("results/quick: error: none of its 1 starts")));
  }
}

}  // namespace
}  // namespace glocal::test::comparison_test
