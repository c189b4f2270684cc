// What is learned from a sweep, against numbers by hand.
#include "evaluation/sweeps/analysis.hpp"

#include <gmock/gmock.h>

#include "evaluation/sweeps/runs.hpp"
#include "files.hpp"
#include "glocal/error.hpp"

namespace glocal::test::analysis_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names(const SweepAnalysis& analysis) {
  std::vector<std::string> names;
  for (const SettingResult& setting : analysis.settings) names.push_back(setting.name);
  return names;
}

TEST(Sweep, ScoreRanksAndFewerStepsSettleTies) {
  const std::vector<NamedRun> runs = {sweep_run({"undecided"}, "ruuu"), sweep_run({"bold"}, "rrww"),
                                      sweep_run({"slow"}, "rrru", 30.0), sweep_run({"quick"}, "rrru", 20.0),
                                      sweep_run({"all"}, "rrrr", 60.0)};
  const SweepAnalysis analysis = analyse_sweep(runs);
  // Scores: 1, 3/4, 3/4, 1/4 and 2/4 - 2/4.
  EXPECT_THAT(names(analysis), ElementsAre("all", "quick", "slow", "undecided", "bold"));
  EXPECT_DOUBLE_EQ(analysis.settings[1].chosen.score(), 0.75);
  EXPECT_DOUBLE_EQ(analysis.settings[4].chosen.score(), 0.0);
  EXPECT_EQ(analysis.settings[4].chosen.wrong, 2U);
  EXPECT_EQ(analysis.settings[1].chosen.median_steps, 20.0);
  // 3 of 4, Wilson: 0.3006 to 0.9544.
  EXPECT_NEAR(analysis.settings[1].chosen.success.low, 0.300642, 1e-6);
  EXPECT_NEAR(analysis.settings[1].chosen.success.high, 0.954413, 1e-6);
}

TEST(Sweep, SeedsOfAPlaceAreNoTrialsOfTheirOwn) {
  // The same outcomes with both seeds tell no more than those with one.
  const std::vector<NamedRun> twice = {sweep_run({.setting = "a", .seed = 1}, "rrru"),
                                       sweep_run({.setting = "a", .seed = 2}, "rrru")};
  const SettingOutcome outcome = analyse_sweep(twice).settings.at(0).chosen;
  EXPECT_EQ(outcome.trials, 8U);
  EXPECT_NEAR(outcome.success.low, 0.300642, 1e-6);
  EXPECT_NEAR(outcome.success.high, 0.954413, 1e-6);
}

TEST(Sweep, LeadsAreThoseOfPlacesWithAllTheirSeeds) {
  std::vector<NamedRun> runs;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    runs.push_back(sweep_run({.setting = "a", .seed = seed}, "uur"));
    runs.push_back(sweep_run({.setting = "b", .seed = seed}, "rrr"));
    runs.push_back(sweep_run({.setting = "c", .seed = seed}, "rru"));
  }
  const SweepAnalysis analysis = analyse_sweep(runs);
  EXPECT_THAT(names(analysis), ElementsAre("b", "c", "a"));
  ASSERT_TRUE(analysis.chance.has_value());
  EXPECT_EQ(analysis.chance->places, 3U);
  EXPECT_EQ(analysis.chance->trials, 9U);
  EXPECT_EQ(analysis.chance->baseline, "a");
  EXPECT_EQ(analysis.chance->second, "c");
  ASSERT_TRUE(analysis.settings[0].over_baseline.has_value());
  EXPECT_EQ(analysis.settings[0].over_baseline->score, 6);
  EXPECT_EQ(analysis.settings[0].over_baseline->places_better, 2U);
  EXPECT_DOUBLE_EQ(analysis.settings[0].over_baseline->p, 0.5) << "seeds are no places";
  EXPECT_EQ(analysis.chance->over_second.score, 3);
  EXPECT_FALSE(analysis.settings[2].over_baseline.has_value());
  EXPECT_EQ(analyse_sweep(runs, {}, "c").settings[2].over_baseline->score, -3);
  EXPECT_THROW(static_cast<void>(analyse_sweep(runs, {}, "d")), ConfigError);
}

TEST(Sweep, NestedAndPlainPathsAreOneParameter) {
  const std::vector<NamedRun> runs = {
      sweep_run({.setting = "k", .values = {{"localizer.clusterer.hierarchical_kmeans.seeds", "9"}}}, "rr"),
      sweep_run({.setting = "d", .values = {{"localizer.clusterer", "dbscan"}}}, "ru")};
  const SweepAnalysis analysis = analyse_sweep(runs);
  ASSERT_EQ(analysis.parameters.effects.size(), 1U);
  const ParameterEffect& clusterer = analysis.parameters.effects[0];
  EXPECT_EQ(clusterer.path, "localizer.clusterer");
  ASSERT_EQ(clusterer.levels.size(), 2U);
  EXPECT_EQ(clusterer.levels[0].label, "hierarchical_kmeans");
  EXPECT_EQ(clusterer.levels[1].label, "dbscan");
}

TEST(Sweep, TheMethodIsAParameter) {
  const SweepAnalysis analysis =
      analyse_sweep({sweep_run({.setting = "a", .values = {{"method", "a"}}}, "rr"),
                     sweep_run({.setting = "b", .values = {{"method", "b"}}}, "ru")});
  ASSERT_EQ(analysis.parameters.effects.size(), 1U);
  EXPECT_EQ(analysis.parameters.effects[0].label, "method");
}

TEST(Sweep, WhatIsChosenAndWhatIsJudgedAreKeptApart) {
  const auto run = [](const std::string& setting, const std::string& role, const std::string& outcomes) {
    return sweep_run({.setting = setting, .case_name = role == "judge" ? "far" : "near", .role = role},
                     outcomes);
  };
  const std::vector<NamedRun> runs = {run("a", "choose", "rrr"), run("a", "judge", "uuur"),
                                      run("b", "choose", "ruu"), run("b", "judge", "rrrr")};
  const SweepAnalysis analysis = analyse_sweep(runs);
  EXPECT_THAT(names(analysis), ElementsAre("a", "b"));
  EXPECT_EQ(analysis.settings[0].chosen.trials, 3U);
  ASSERT_TRUE(analysis.settings[0].judged.has_value());
  EXPECT_EQ(analysis.settings[0].judged->right, 1U);
  EXPECT_EQ(analysis.settings[1].judged->right, 4U);
  EXPECT_THAT(analysis.choose_on, ElementsAre("near"));
  EXPECT_THAT(analysis.judge_on, ElementsAre("far"));
}

TEST(Sweep, IncompleteSettingsAreLastAndNeverTheBest) {
  std::vector<NamedRun> runs = {
      sweep_run({.setting = "a", .seed = 1}, "ru"), sweep_run({.setting = "a", .seed = 2}, "ru"),
      sweep_run({.setting = "missing", .seed = 1}, "rr"), sweep_run({.setting = "cut", .seed = 1}, "rr"),
      sweep_run({.setting = "cut", .seed = 2}, "r")};
  runs.back().results.complete = false;
  const SweepAnalysis analysis = analyse_sweep(runs);
  EXPECT_THAT(names(analysis), ElementsAre("a", "missing", "cut")) << "equal ones in the order of their runs";
  EXPECT_TRUE(analysis.settings[0].complete);
  EXPECT_FALSE(analysis.settings[1].complete);
  EXPECT_FALSE(analysis.settings[2].complete);
  EXPECT_THAT(analysis.incomplete, ElementsAre("cut__seed-2"));
  EXPECT_FALSE(analysis.chance.has_value()) << "there is nothing to be better than";
}

TEST(Sweep, IncompleteSettingsDoNotCountInWhatAParameterDoes) {
  const auto run = [](const std::string& setting, const std::string& value, std::uint64_t seed,
                      const std::string& outcomes) {
    return sweep_run({.setting = setting, .values = {{"localizer.clusterer", value}}, .seed = seed},
                     outcomes);
  };
  // The second seed is the harder one, and c lacks it.
  std::vector<NamedRun> runs = {run("a", "k", 1, "rr"), run("a", "k", 2, "uu"), run("b", "d", 1, "rr"),
                                run("b", "d", 2, "ru"), run("c", "d", 1, "rr")};
  const SweepAnalysis analysis = analyse_sweep(runs);
  const auto& levels = analysis.parameters.effects.at(0).levels;
  EXPECT_DOUBLE_EQ(levels.at(0).outcome.success.value, 0.5);
  EXPECT_DOUBLE_EQ(levels.at(1).outcome.success.value, 0.75);
  // Where all lack something, that is all there is.
  for (NamedRun& each : runs) each.results.complete = false;
  EXPECT_DOUBLE_EQ(analyse_sweep(runs).parameters.effects.at(0).levels.at(1).outcome.success.value,
                   5.0 / 6.0);
}

/// Two parameters of a grid, right at so many of 4 starts.
std::vector<NamedRun> grid() {
  std::vector<NamedRun> runs;
  const auto add = [&](const std::string& a, const std::string& b, const std::string& outcomes) {
    runs.push_back(sweep_run({.setting = a + b, .values = {{"x.size", a}, {"y.kind", b}}}, outcomes));
  };
  add("10", "plain", "uuuu");
  add("10", "fine", "ruuu");
  add("2", "plain", "rruu");
  add("2", "fine", "rrrr");
  return runs;
}

TEST(Sweep, EffectsAreMeansOverAllElse) {
  const SweepAnalysis analysis = analyse_sweep(grid());
  ASSERT_EQ(analysis.parameters.effects.size(), 2U);
  // By size: 6 of 8 with 2, 1 of 8 with 10. By kind: 2 of 8 plain, 5 of 8 fine.
  const ParameterEffect& size = analysis.parameters.effects[0];
  EXPECT_EQ(size.path, "x.size");
  EXPECT_EQ(size.label, "size");
  EXPECT_FALSE(size.is_binned);
  ASSERT_EQ(size.levels.size(), 2U);
  EXPECT_EQ(size.levels[0].label, "2");
  EXPECT_DOUBLE_EQ(size.levels[0].outcome.success.value, 0.75);
  EXPECT_EQ(size.levels[0].outcome.settings, 2U);
  EXPECT_EQ(size.levels[0].outcome.trials, 8U);
  EXPECT_DOUBLE_EQ(size.levels[1].outcome.success.value, 0.125);
  EXPECT_DOUBLE_EQ(size.range, 0.625);
  // Values 10, 10, 2, 2 and successes 0, 1/4, 1/2, 1: ranks 3.5, 3.5, 1.5, 1.5 and 1, 2, 3, 4.
  EXPECT_NEAR(size.spearman.value_or(0.0), -4.0 / std::sqrt(4.0 * 5.0), 1e-12);
  const ParameterEffect& kind = analysis.parameters.effects[1];
  EXPECT_EQ(kind.levels[0].label, "plain");
  EXPECT_DOUBLE_EQ(kind.range, 0.375);
  EXPECT_FALSE(kind.spearman.has_value());
  ASSERT_TRUE(analysis.parameters.map.has_value());
  // Rows: 2 and 10; columns: plain and fine.
  EXPECT_DOUBLE_EQ(analysis.parameters.map->cells[0][0].success.value, 0.5);
  EXPECT_DOUBLE_EQ(analysis.parameters.map->cells[0][1].success.value, 1.0);
  EXPECT_DOUBLE_EQ(analysis.parameters.map->cells[1][0].success.value, 0.0);
  EXPECT_DOUBLE_EQ(analysis.parameters.map->cells[1][1].success.value, 0.25);
}

TEST(Sweep, TheIntervalOfAnEffectIsThatOfItsPlaces) {
  // 6 of 8 over 4 places with 2, 2, 1 and 1 right ones: the excess over 1.5 is 0.5 each, so that the squares
  // are 1, and the variance 4/3 / 64, where that of independent ones is 0.75 * 0.25 / 7; t is 2.3646 with 7
  // degrees of freedom, 3.1824 with 3: 5.679 independent trials. Computed with SciPy 1.10.
  const Proportion interval = analyse_sweep(grid()).parameters.effects[0].levels[0].outcome.success;
  EXPECT_NEAR(interval.low, 0.35614434019681224, 1e-9);
  EXPECT_NEAR(interval.high, 0.9420983094069992, 1e-9);
}

TEST(Sweep, ManyNumbersAreShownInQuarters) {
  std::vector<NamedRun> runs;
  // 1 to 8: quantiles 1, 2.75, 4.5, 6.25, 8, so that each quarter has two values; the upper half is right.
  for (int i = 8; i >= 1; --i) {
    runs.push_back(sweep_run({.setting = "s" + std::to_string(i), .values = {{"a.n", std::to_string(i)}}},
                             i > 4 ? "rr" : "uu"));
  }
  runs.push_back(sweep_run({.setting = "base"}, "rr"));
  const ParameterEffect effect = analyse_sweep(runs).parameters.effects.at(0);
  EXPECT_TRUE(effect.is_binned);
  ASSERT_EQ(effect.levels.size(), 4U);
  EXPECT_EQ(effect.levels[0].label, "1 to 2.75");
  EXPECT_EQ(effect.levels[3].label, "6.25 to 8");
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(effect.levels[k].outcome.settings, 2U);
    EXPECT_DOUBLE_EQ(effect.levels[k].outcome.success.value, k < 2 ? 0.0 : 1.0);
  }
  EXPECT_DOUBLE_EQ(effect.range, 1.0);
}

/// 2 x 2 settings at 3 starts, of which the first run lacks the last one.
std::vector<NamedRun> compared_grid() {
  std::vector<NamedRun> runs;
  const auto add = [&](const std::string& a, const std::string& b, const std::string& outcomes,
                       double steps) {
    runs.push_back(sweep_run({.setting = a + b, .values = {{"x.size", a}, {"y.kind", b}}}, outcomes, steps));
  };
  add("10", "plain", "uw", 5);
  add("10", "fine", "ruw", 5);
  add("2", "plain", "rrw", 9);
  add("2", "fine", "rrw", 7);
  return runs;
}

TEST(ComparedParameters, AreThoseOverTheStartsThatAllRunsHave) {
  const auto figures = compare_parameters(compared_grid(), true);
  ASSERT_TRUE(figures.has_value());
  ASSERT_EQ(figures->effects.size(), 2U);
  // By size, over the first two starts: 4 of 4 with 2, 1 of 4 with 10, where the one is wrong.
  const ParameterEffect& size = figures->effects[0];
  EXPECT_EQ(size.levels[0].label, "2");
  EXPECT_EQ(size.levels[0].outcome.trials, 4U);
  EXPECT_EQ(size.levels[0].outcome.wrong, 0U);
  EXPECT_DOUBLE_EQ(size.levels[0].outcome.success.value, 1.0);
  EXPECT_EQ(size.levels[0].outcome.median_steps, 8.0) << "9, 9, 7, 7";
  EXPECT_EQ(size.levels[1].outcome.trials, 4U);
  EXPECT_EQ(size.levels[1].outcome.wrong, 1U);
  EXPECT_DOUBLE_EQ(size.levels[1].outcome.success.value, 0.25);
  EXPECT_EQ(size.levels[1].outcome.median_steps, 5.0);
  ASSERT_TRUE(figures->map.has_value());
  EXPECT_EQ(figures->map->cells[0][0].median_steps, 9.0);
  EXPECT_EQ(figures->map->cells[0][1].median_steps, 7.0);
  EXPECT_EQ(figures->map->cells[1][0].median_steps, std::nullopt);
}

TEST(ComparedParameters, TellTimesWhereTheyCanBeCompared) {
  std::vector<NamedRun> runs = compared_grid();
  // 2 ms for each step of right trials, and 5 ms: 18, 18, 14, 14 with 2.
  const auto time_with_2 = [&](bool with_times) {
    return compare_parameters(runs, with_times)->effects[0].levels[0].outcome.median_step_cpu_ms;
  };
  EXPECT_EQ(time_with_2(true), 16.0);
  EXPECT_EQ(time_with_2(false), std::nullopt);
  runs[1].results.machine.host = "another";
  runs[0].results.machine.host = "one";
  EXPECT_EQ(time_with_2(true), std::nullopt);
}

TEST(ComparedParameters, AreAtMostTwoAndOfOneExperiment) {
  std::vector<NamedRun> runs = {sweep_run({.setting = "a", .values = {{"x.size", "1"}}}, "r"),
                                sweep_run({.setting = "b", .values = {{"x.size", "2"}}}, "r")};
  ASSERT_TRUE(compare_parameters(runs, true).has_value());
  EXPECT_FALSE(compare_parameters(runs, true)->map.has_value());
  runs[1].results.experiment = "other";
  EXPECT_FALSE(compare_parameters(runs, true).has_value());
  runs = {sweep_run({.setting = "a", .values = {{"method", "a"}}}, "r"),
          sweep_run({.setting = "b", .values = {{"method", "b"}}}, "r")};
  EXPECT_FALSE(compare_parameters(runs, true).has_value()) << "all is told of methods already";
  runs = {sweep_run({.setting = "a", .values = {{"x.size", "1"}, {"x.side", "1"}, {"y.kind", "plain"}}}, "r"),
          sweep_run({.setting = "b", .values = {{"x.size", "2"}, {"x.side", "2"}, {"y.kind", "fine"}}}, "r")};
  EXPECT_FALSE(compare_parameters(runs, true).has_value());
}

TEST(Sweep, TheMapShowsWhatIsAskedFor) {
  std::vector<NamedRun> runs;
  for (int i = 0; i < 8; ++i) {
    const auto bit = [&](int k) { return std::string((i >> k) % 2 == 0 ? "off" : "on"); };
    runs.push_back(sweep_run(
        {.setting = "s" + std::to_string(i), .values = {{"p.a", bit(0)}, {"p.b", bit(1)}, {"q.b", bit(2)}}},
        i >= 4 ? "rr" : (i % 2 == 0 ? "ru" : "uu")));
  }
  const SweepAnalysis two = analyse_sweep(runs, std::pair("a", "q.b"));
  EXPECT_EQ(two.parameters.effects[two.parameters.map->row].path, "p.a");
  EXPECT_EQ(two.parameters.effects[two.parameters.map->column].path, "q.b");
  EXPECT_EQ(two.parameters.effects[0].path, "q.b") << "of the largest effect";
  const auto fault = [&](const std::string& a, const std::string& b) {
    return error_of([&] { return analyse_sweep(runs, std::pair(a, b)); });
  };
  EXPECT_EQ(fault("b", "a"), "--map b: error: more than one parameter ends so; name its whole path");
  EXPECT_EQ(fault("a", "a"), "--map a a: error: is one parameter twice; name two");
  EXPECT_EQ(fault("nowhere", "a"),
            "--map nowhere: error: no such parameter varies (there are: q.b, p.a, p.b)");
}

TEST(Sweep, RefusesWhatIsNoSweep) {
  const auto fault = [](const std::vector<NamedRun>& runs) {
    return error_of([&] { return analyse_sweep(runs); });
  };
  std::vector<NamedRun> runs = {sweep_run({"a"}, "r"), sweep_run({"b"}, "r")};
  EXPECT_TRUE(is_sweep(runs));
  runs[1].results.provenance.erase("variant");
  EXPECT_FALSE(is_sweep(runs));
  EXPECT_THAT(fault(runs), HasSubstr("results/b__seed-1/provenance.json: error: does not say which setting"));
  EXPECT_THAT(fault({sweep_run({"a"}, "r"), sweep_run({"a"}, "r")}),
              HasSubstr("is of the same setting, case and seed as a__seed-1"));
  runs = {sweep_run({"a"}, "r"), sweep_run({.setting = "a", .seed = 2}, "r")};
  for (NamedRun& run : runs) run.results.settings["localizer.contact_epsilon"] = {"0.1", "0.1"};
  EXPECT_TRUE(is_sweep(runs));
  runs[1].results.settings["localizer.contact_epsilon"] = {"0.2", "0.2"};
  EXPECT_THAT(fault(runs),
              HasSubstr("has another localizer.contact_epsilon than a__seed-1, and both are of the "
                        "setting 'a'"));
  runs = {sweep_run({"a"}, "r"), sweep_run({"b"}, "r")};
  runs[1].results.experiment = "other";
  EXPECT_THAT(fault(runs), HasSubstr("is of the experiment other, others are of toy"));
  runs = {sweep_run({"a"}, "r"), sweep_run({"b"}, "r")};
  runs[1].results.provenance["variant"]["role"] = "juge";
  EXPECT_THAT(fault(runs), HasSubstr("is not as glocal run leaves it (there is no role 'juge')"));
}

}  // namespace
}  // namespace glocal::test::analysis_test
