#include "evaluation/comparison/comparison.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluation/comparison/comparison_report.hpp"
#include "evaluation/comparison/runs.hpp"
#include "evaluation/sweeps/runs.hpp"
#include "files.hpp"

namespace glocal::test::comparison_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

const OutcomeDifference& wrong_of(const PairComparison& pair) {
  return pair.outcomes[0];
}
const OutcomeDifference& right_of(const PairComparison& pair) {
  return pair.outcomes[1];
}

TEST(Comparison, CountsOutcomesStartByStart) {
  const Comparison comparison = compare(slow_and_quick(), 0);
  EXPECT_EQ(comparison.baseline, "slow");
  EXPECT_EQ(comparison.starts, 30U);
  EXPECT_EQ(comparison.places, 30U);
  ASSERT_EQ(comparison.pairs.size(), 1U);
  ASSERT_EQ(comparison.pairs.front().outcomes.size(), 2U);
  const OutcomeDifference& right = right_of(comparison.pairs.front());
  EXPECT_EQ(right.counts.both, 20U);
  EXPECT_EQ(right.counts.only_baseline, 1U);
  EXPECT_EQ(right.counts.only_variant, 9U);
  EXPECT_EQ(right.counts.neither, 0U);
  EXPECT_EQ(right.places_more, 9U);
  EXPECT_EQ(right.places_less, 1U);
  EXPECT_NEAR(right.points.value, 100.0 * 8.0 / 30.0, 1e-9);
  EXPECT_LT(right.points.interval.low, right.points.value);
  EXPECT_GT(right.points.interval.high, right.points.value);
  EXPECT_DOUBLE_EQ(right.test.p, 2.0 * 11.0 / 1024.0);  // (C(10,0) + C(10,1)) / 2^10, twice
  const OutcomeDifference& wrong = wrong_of(comparison.pairs.front());
  EXPECT_EQ(wrong.counts.only_baseline, 9U);
  EXPECT_EQ(wrong.counts.only_variant, 0U);
  EXPECT_DOUBLE_EQ(wrong.test.p, 2.0 / 512.0);
}

TEST(Comparison, SumsUpEachRun) {
  const Comparison comparison = compare(slow_and_quick(), 0);
  ASSERT_EQ(comparison.methods.size(), 2U);
  const MethodFigures& slow = comparison.methods[0];
  EXPECT_EQ(slow.outcomes.right, 21U);
  EXPECT_EQ(slow.outcomes.wrong, 9U);
  EXPECT_EQ(slow.outcomes.undecided, 0U);
  EXPECT_DOUBLE_EQ(slow.success.value, 0.7);
  EXPECT_EQ(comparison.methods[1].outcomes.undecided, 1U);
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
  EXPECT_EQ(steps.trials, 20U);
  EXPECT_EQ(steps.places, 20U);
  EXPECT_EQ(steps.baseline_median, 19.5);
  EXPECT_EQ(steps.variant_median, 17.5);
  EXPECT_EQ(steps.median, -2.0);
  EXPECT_EQ(steps.mean.value, -2.0);
  EXPECT_EQ(steps.mean.interval.low, -2.0);
  EXPECT_DOUBLE_EQ(steps.test.p, std::exp2(-19.0));  // all 20 of one sign
  EXPECT_EQ(pair.measures[1].median, -1.0);          // m
  const MeasureDifference& time = pair.measures[4];
  EXPECT_STREQ(time.measure.name, "step_cpu_ms");
  EXPECT_EQ(time.trials, 30U);
}

TEST(Comparison, CorrectsInTwoFamiliesOfTestsThatHaveAChance) {
  std::vector<NamedRun> runs = slow_and_quick();
  runs.push_back(run_of("same", std::vector<TrialResult>()));
  runs[2].results.trials = runs[0].results.trials;
  const Comparison comparison = compare(runs, 0);
  // Where nothing differs nothing is tested.
  EXPECT_EQ(comparison.outcome_tests, 2U);
  EXPECT_EQ(comparison.measure_tests, 5U);
  const PairComparison& quick = comparison.pairs[0];
  // Smallest of two, then of one.
  EXPECT_DOUBLE_EQ(wrong_of(quick).test.p_holm, 2.0 * 2.0 / 512.0);
  EXPECT_DOUBLE_EQ(right_of(quick).test.p_holm, 22.0 / 1024.0);
  EXPECT_FALSE(right_of(comparison.pairs[1]).test.has_chance());
  EXPECT_EQ(right_of(comparison.pairs[1]).test.p_holm, 1.0);
}

TEST(Comparison, FivePlacesThatDifferAreNoTestOfTheFamily) {
  // At 5 places both are right or not, all one way: p is 0.0625. At 6 steps differ: 0.03125, which Holm
  // leaves.
  std::vector<TrialResult> first(25, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 5; ++i) {
    second[i] = ended(Outcome::undecided);
    second[i].step_cpu_ms = first[i].step_cpu_ms;
  }
  for (std::size_t i = 5; i < 11; ++i) second[i].steps = 8.0;
  const Comparison comparison = compare({run_of("a", first), run_of("b", second)}, 0);
  EXPECT_EQ(comparison.outcome_tests, 0U);
  EXPECT_EQ(comparison.measure_tests, 1U);
  const PairComparison& pair = comparison.pairs.front();
  EXPECT_DOUBLE_EQ(right_of(pair).test.p, 0.0625);
  EXPECT_EQ(pair.measures[0].test.p_holm, 0.03125);
  EXPECT_THAT(pair.warnings,
              ElementsAre(AllOf(HasSubstr("fewer than 6"), HasSubstr("this is so for right (5)."))));
}

TEST(Comparison, SaysWhoIsBetterInWhatMattersFirst) {
  const PairComparison quick = compare(slow_and_quick(), 0).pairs.front();
  EXPECT_THAT(
      quick.conclusion,
      AllOf(MatchesRegex("quick is better than slow: wrong less often \\(-30.0 points, .* to .*, p = "
                         "0.008\\) and right more often \\(\\+26.7 points, .*, p = 0.021\\)\\. Lower: .*"),
            HasSubstr(" Lower: steps to localize (-2 in the mean of 20 starts, which all differ, p < 0.001)"),
            HasSubstr("translation error (-0.02 m ")));
  const PairComparison slow = compare(slow_and_quick(), 1).pairs.front();
  EXPECT_THAT(slow.conclusion, StartsWith("slow is worse than quick: wrong more often (+30.0 points"));
}

TEST(Comparison, WhatIsRightLessOftenIsNotHeadlinedForBeingFast) {
  // Right at 2 and 6 of 12 starts, which 4 places cannot tell, and in half the time, which is sure.
  std::vector<TrialResult> first(12, ended(Outcome::undecided));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 6; ++i) first[i] = right_after(10.0);
  for (std::size_t i = 0; i < 2; ++i) second[i] = right_after(10.0);
  for (std::size_t i = 0; i < 12; ++i) {
    first[i].step_cpu_ms = 20.0 + static_cast<double>(i);
    second[i].step_cpu_ms = 8.0;
  }
  const std::string conclusion =
      compare({run_of("paper", first), run_of("few", second)}, 0).pairs.front().conclusion;
  EXPECT_THAT(conclusion, StartsWith("few against paper: "));
  EXPECT_THAT(conclusion, HasSubstr("Nothing can be told of right (-33.3 points, "));
  EXPECT_LT(conclusion.find("Nothing can be told of right"),
            conclusion.find("Lower: CPU time of a step (-17.5 ms"));
  EXPECT_THAT(conclusion, Not(HasSubstr("better")));
}

TEST(Comparison, SaysHowManyMorePlacesItTakes) {
  std::vector<TrialResult> first(25, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 3; ++i) second[i] = ended(Outcome::undecided);
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  // 1 and 4 of 27 pairs with the two that are added: the error is sqrt(5/27 - 9/27^2) / sqrt(27) = 8.0
  // points.
  const double error = 100.0 * std::sqrt((5.0 / 27.0 - 9.0 / 729.0) / 27.0);
  const double needed = std::ceil(25.0 * std::pow(2.801585 * error / 2.0, 2.0));
  EXPECT_NEAR(right_of(pair).places_needed, needed, 1.0);
  EXPECT_THAT(pair.conclusion,
              ContainsRegex("Nothing can be told of right \\(-12.0 points, [^;]*; about 3[12]00 "
                            "more places would tell 2 points\\)"));
  EXPECT_THAT(pair.conclusion, HasSubstr("No place differs in wrong: "));
}

TEST(Comparison, LeavesOutMeasuresThatNoStartHas) {
  std::vector<TrialResult> never(25, ended(Outcome::undecided));
  for (TrialResult& trial : never) trial.step_cpu_ms.reset();
  const Comparison comparison =
      compare({run_of("a", std::vector<TrialResult>(25, right_after(10.0))), run_of("never", never)}, 0);
  EXPECT_THAT(comparison.pairs.front().measures, IsEmpty());
  EXPECT_EQ(comparison.methods[1].medians[0], std::nullopt);
  EXPECT_EQ(comparison.measure_tests, 0U);
  EXPECT_THAT(
      comparison.pairs.front().warnings,
      Contains(HasSubstr("no two places at which both have a value for steps to localize, way to localize")));
}

TEST(Comparison, SaysNothingOfMeasuresThatAreNotAskedFor) {
  std::vector<NamedRun> runs = slow_and_quick();
  EXPECT_EQ(compare(runs, 0, measures_but_time()).measure_tests, 4U);
  for (NamedRun& run : runs) {
    for (auto& [start, trial] : run.results.trials) trial.step_cpu_ms.reset();
  }
  const Comparison all = compare(runs, 0);
  const Comparison some = compare(runs, 0, measures_but_time());
  EXPECT_EQ(all.methods[0].medians.size(), 5U);
  EXPECT_EQ(some.methods[0].medians.size(), 4U);
  EXPECT_THAT(all.pairs.front().warnings,
              ElementsAre(HasSubstr("both have a value for CPU time of a step.")));
  EXPECT_THAT(some.pairs.front().warnings, IsEmpty());
  EXPECT_THAT(as_text(first_screen(all)), HasSubstr("CPU, ms"));
  EXPECT_THAT(as_text(first_screen(some)), Not(HasSubstr("CPU, ms")));
}

TEST(Comparison, EffectsAreOfAllStartsAndThoseThatDifferAreNamed) {
  // 30 starts; at 12 of them the variant takes 4 steps fewer, elsewhere as many.
  std::vector<TrialResult> first(30, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 12; ++i) second[i] = right_after(6.0);
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  EXPECT_EQ(pair.measures[0].median, 0.0);
  EXPECT_DOUBLE_EQ(pair.measures[0].mean.value, -1.6);
  EXPECT_EQ(pair.measures[0].mean_of_those, -4.0);
  EXPECT_THAT(pair.conclusion,
              HasSubstr("steps to localize (-1.6 in the mean of 30 starts, of which 12 differ, p = 0.002)"));
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
  EXPECT_LT(pair.measures[2].test.p_holm, 0.001);
  EXPECT_TRUE(pair.measures[4].matters());
  // 5 % of the median, 49 ms.
  EXPECT_DOUBLE_EQ(pair.measures[4].smallest, 0.05 * 49.0);
  EXPECT_THAT(pair.conclusion, AllOf(HasSubstr(" Higher: CPU time of a step (+2.9"),
                                     HasSubstr("No difference that matters: translation error (-0.001 m")));
}

TEST(Comparison, RanksAndMeanMustAgree) {
  // One step more at 20 starts, 60 fewer at one: ranks say more, the mean says less.
  std::vector<TrialResult> first(30, right_after(70.0));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 20; ++i) second[i].steps = 71.0;
  second[20].steps = 10.0;
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  const MeasureDifference& steps = pair.measures[0];
  EXPECT_TRUE(steps.test.is_significant());
  EXPECT_LT(steps.mean.value, -0.5);
  EXPECT_FALSE(steps.matters());
  EXPECT_THAT(pair.conclusion,
              AllOf(HasSubstr(" At most places the other way than in the mean: steps to localize (-1.33"),
                    Not(HasSubstr("No difference that matters: steps"))));
}

TEST(Comparison, IsSureOfALittleDifferenceOnlyWhereAllOfItsIntervalIsLittle) {
  // 9 of 1000 starts wrong with one method only: 0.9 points, of which 1 matters, and 0.3 to 1.5 may be.
  std::vector<TrialResult> first(1000, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (std::size_t i = 0; i < 9; ++i) second[i].outcome = Outcome::wrong;
  EXPECT_THAT(
      compare({run_of("a", first), run_of("b", second)}, 0).pairs.front().conclusion,
      HasSubstr(
          "b is wrong more often (+0.9 points, +0.3 to +1.5, p = 0.008): perhaps by less than 1 point."));
  // 1.2 steps more at a third of 60 starts: 0.4 in the mean, of which 0.5 matter.
  first.resize(60);
  second = first;
  for (std::size_t i = 0; i < 20; ++i) second[i].steps += 1.2;
  EXPECT_THAT(compare({run_of("a", first), run_of("b", second)}, 0).pairs.front().conclusion,
              HasSubstr(" Perhaps too small to matter: steps to localize (+0.4 in the mean of 60 starts"));
}

TEST(Comparison, TakesRoundingForNoDifference) {
  std::vector<TrialResult> first(30, right_after(10.0));
  std::vector<TrialResult> second = first;
  for (TrialResult& trial : second) trial.distance_m += 1.78e-15;
  const PairComparison pair = compare({run_of("a", first), run_of("b", second)}, 0).pairs.front();
  EXPECT_EQ(pair.measures[1].test.differing, 0U);
  EXPECT_EQ(pair.measures[1].mean.value, 0.0);
}

TEST(Comparison, TestsNoTimesThatTellOfTheMachine) {
  std::vector<NamedRun> runs = slow_and_quick();
  EXPECT_EQ(compare(runs, 0).measure_tests, 5U);
  runs[1].results.machine.jobs = 2;
  const Comparison comparison = compare(runs, 0);
  EXPECT_EQ(comparison.measure_tests, 4U);
  EXPECT_TRUE(comparison.methods[0].medians.at(4));
  EXPECT_TRUE(comparison.methods[1].medians.at(3));
  EXPECT_FALSE(comparison.methods[1].medians.at(4)) << "nor tells them side by side";
  EXPECT_THAT(comparison.warnings, Contains(HasSubstr("--jobs 2, and --jobs 1")));
  EXPECT_THAT(comparison.pairs.front().warnings, IsEmpty());
  EXPECT_THAT(compare(runs, 0, measures_but_time()).warnings, IsEmpty()) << "nor is it asked for";
}

TEST(Comparison, AMedianOfTimesIsOneOfAllRuns) {
  std::vector<NamedRun> runs = {
      sweep_run({.setting = "a", .seed = 1}, "rr"), sweep_run({.setting = "a", .seed = 2}, "rr"),
      sweep_run({.setting = "b", .seed = 1}, "rr"), sweep_run({.setting = "b", .seed = 2}, "rr")};
  for (NamedRun& run : runs) {
    for (auto& [start, trial] : run.results.trials) trial.step_cpu_ms = 3.0;
  }
  EXPECT_TRUE(compare(runs, 0).methods[1].medians.at(4));
  runs[3].results.machine.host = "other";
  const Comparison comparison = compare(runs, 0);
  EXPECT_FALSE(comparison.methods[1].medians.at(4));
  EXPECT_EQ(comparison.pairs.front().measures.at(4).trials, 2U) << "the others are compared";
}

TEST(Comparison, TakesOnlyStartsThatAllHave) {
  std::vector<NamedRun> runs = slow_and_quick();
  runs[0].results.trials.erase(runs[0].results.trials.begin());
  runs[1].results.trials.erase(std::prev(runs[1].results.trials.end()));
  const Comparison comparison = compare(runs, 0);
  EXPECT_EQ(comparison.starts, 28U);
  EXPECT_EQ(right_of(comparison.pairs.front()).counts.both, 19U);
  EXPECT_THAT(
      comparison.warnings,
      Contains("Only the 28 starts that all methods have are compared. Left out: 1 of slow, 1 of quick."));
}

TEST(Comparison, RefusesRunsWithoutACommonStart) {
  std::vector<NamedRun> runs = slow_and_quick();
  const TrialResult trial = right_after(3.0);
  runs[1].results.trials = {{{0, 0.5, 1000.0}, trial}};
  EXPECT_THAT(error_of([&] { return compare(runs, 0); }),
              AllOf(HasSubstr("results/slow: error: none of its 30 starts"),
                    HasSubstr("results/quick: error: none of its 1 starts")));
}

/// Methods a and b in two cases with two seeds, of which b is never right at the second place of `far`.
std::vector<NamedRun> product() {
  std::vector<NamedRun> runs;
  for (const char* method : {"a", "b"}) {
    for (const char* one_case : {"near", "far"}) {
      for (const std::uint64_t seed : {1U, 2U}) {
        const bool fails = std::string(method) == "b" && std::string(one_case) == "far";
        runs.push_back(sweep_run({.setting = method, .case_name = one_case, .seed = seed},
                                 std::string(one_case) == "near" ? "rrr"
                                 : fails                         ? "ru"
                                                                 : "rr"));
      }
    }
  }
  return runs;
}

TEST(Comparison, PairsWithinCaseAndSeedAndPools) {
  const Comparison comparison = compare(product(), 0);
  EXPECT_EQ(comparison.starts, 10U);
  EXPECT_EQ(comparison.places, 5U);
  EXPECT_THAT(comparison.cases, ElementsAre("near", "far"));
  EXPECT_THAT(comparison.seeds, ElementsAre(1U, 2U));
  ASSERT_EQ(comparison.methods.size(), 2U);
  EXPECT_EQ(comparison.methods[1].name, "b");
  EXPECT_EQ(comparison.methods[1].folders.size(), 4U);
  EXPECT_EQ(comparison.methods[1].cases[0].outcomes.right, 6U);
  EXPECT_EQ(comparison.methods[1].cases[1].outcomes.right, 2U);
  EXPECT_DOUBLE_EQ(comparison.methods[1].cases[1].right_points->value, -50.0);
  const OutcomeDifference& right = right_of(comparison.pairs.front());
  EXPECT_DOUBLE_EQ(right.points.value, -20.0);
  // Both seeds fail at one place: that is one place, and p is 1.
  EXPECT_EQ(right.places_less, 1U);
  EXPECT_EQ(right.test.p, 1.0);
  EXPECT_THAT(as_text(first_screen(comparison)),
              StartsWith("1 method compared with a, by 10 starts: 5 places of 2 cases, 2 seeds\n"));
}

TEST(Comparison, LeavesOutCasesAndSeedsThatOnlySomeMethodsHaveWithOneWarning) {
  std::vector<NamedRun> runs = product();
  runs.erase(runs.begin() + 7);  // b, far, seed 2
  runs.push_back(sweep_run({.setting = "b", .case_name = "farthest", .seed = 1}, "r"));
  const Comparison comparison = compare(runs, 0);
  EXPECT_EQ(comparison.starts, 8U);
  EXPECT_THAT(
      comparison.warnings,
      Contains("Left out, as not all methods have them: far with seed 2 (only a), farthest with seed 1 "
               "(only b)."));
}

TEST(Comparison, RefusesMethodsWithoutACommonCase) {
  const auto fault = [](const Part& a, const Part& b) {
    return error_of([&] { return compare({sweep_run(a, "r"), sweep_run(b, "r")}, 0); });
  };
  EXPECT_THAT(fault({.setting = "a", .case_name = "near"}, {.setting = "b", .case_name = "far"}),
              AllOf(HasSubstr("a was run on near with seed 1: not one case and seed is one of all methods"),
                    HasSubstr("b was run on far with seed 1")));
  EXPECT_THAT(fault({.setting = "a", .seed = 1}, {.setting = "a", .seed = 2}),
              HasSubstr("all runs are of one method, a; name those of another one, too"));
}

TEST(Comparison, TheFirstScreenHasALineForEachMethod) {
  std::vector<NamedRun> runs;
  for (const char* method : {"kmeans", "dbscan", "mean_shift", "greedy"}) {
    for (const char* one_case : {"intel", "fr079"}) {
      for (const std::uint64_t seed : {1U, 2U, 3U})
        runs.push_back(
            sweep_run({.setting = method, .case_name = one_case, .seed = seed},
                      std::string(method) == "dbscan" ? "rrruuuuuuurrrrrrrrrrr" : "rrrrrrrrrrrrrrrrrrrrr"));
    }
  }
  const std::string text = as_text(first_screen(compare(runs, 0)));
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 40);
  EXPECT_THAT(text, HasSubstr("dbscan is worse than kmeans: right less often (-33.3 points, "));
}

}  // namespace
}  // namespace glocal::test::comparison_test
