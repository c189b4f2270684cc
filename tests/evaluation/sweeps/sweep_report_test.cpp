// What is said of a sweep in words.
#include "evaluation/sweeps/sweep_report.hpp"

#include <gmock/gmock.h>

#include "evaluation/sweeps/runs.hpp"

namespace glocal::test::sweep_report_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(SweepReport, TellsChanceFromMore) {
  std::vector<NamedRun> runs = {sweep_run({"a"}, "uuuuuuuuuuuu"), sweep_run({"b"}, "rrrrrrrrrruu"),
                                sweep_run({"c"}, "rrrrrrrrruuu")};
  EXPECT_THAT(
      warnings_of(analyse_sweep(runs)),
      ElementsAre(
          AllOf(StartsWith("b was chosen among 3 settings by the very trials that its numbers are of, so "
                           "they flatter it. It is 83.3 points ahead of a, the baseline (better at 10 "
                           "places, worse at 0; p = 0.0"),
                HasSubstr("So there is more to it than chance"),
                HasSubstr("It is 8.3 points ahead of c, the second best (better at 1 places, worse at 0; p = "
                          "1.000), of which it could be at most 25.0 ahead. Both may be equally good.")),
          "Judge the best by other logs or worlds (judge_on), and report what comes of that."));
  runs = {sweep_run({"a"}, "rru"), sweep_run({"b"}, "urr")};
  EXPECT_THAT(
      warnings_of(analyse_sweep(runs)).front(),
      StartsWith(
          "a, the first of 2 with the same score and steps, was chosen among 2 settings by the very "
          "trials that its numbers are of, so they flatter it. No setting has a better score than a, the "
          "baseline. It is 0.0 points ahead of b, the second best"));
}

TEST(SweepReport, SaysWhereSettingsHaveOtherStartsOrNothingIsCompared) {
  const std::vector<NamedRun> runs = {sweep_run({"a"}, "ruu"), sweep_run({"b"}, "rrrrr")};
  const SweepAnalysis analysis = analyse_sweep(runs);
  EXPECT_EQ(analysis.chance->trials, 3U);
  EXPECT_EQ(warnings_of(analysis).front(),
            "Settings have other starts: scores are of all of them, \"ahead\" is of the 3 that all have.");
  std::vector<NamedRun> incomplete = {sweep_run({"a"}, "rrr"), sweep_run({"b"}, "rru"),
                                      sweep_run({"cut"}, "rru")};
  incomplete.back().results.complete = false;
  EXPECT_THAT(warnings_of(analyse_sweep(incomplete, {}, "cut")),
              Contains("Nothing is compared: cut, the baseline, lacks cases, seeds or trials."));
}

TEST(SweepReport, SaysWhereNoLeadIsPossible) {
  const std::vector<NamedRun> runs = {sweep_run({"a"}, "rrrr"), sweep_run({"b"}, "rrrr"),
                                      sweep_run({"c"}, "rrru")};
  EXPECT_THAT(
      warnings_of(analyse_sweep(runs)).front(),
      HasSubstr("ahead of b, the second best (better at 0 places, worse at 0; p = 1.000), which has no "
                "score left to win: nothing can be ahead of it."));
}

TEST(SweepReport, NamesWhatIsWorseThanTheBaseline) {
  const std::vector<NamedRun> runs = {sweep_run({"kmeans"}, "rrrrrrrrrrrr"),
                                      sweep_run({"other"}, "rrrrrrrrrrrr"),
                                      sweep_run({"dbscan"}, "uuuuuuuuurrr")};
  const SweepAnalysis analysis = analyse_sweep(runs);
  EXPECT_THAT(warnings_of(analysis),
              Contains("Worse than kmeans by more than chance: dbscan (-75.0 points)."));
  EXPECT_THAT(text_report(analysis, 5), HasSubstr("ahead  better  worse      p\n"));
  EXPECT_THAT(text_report(analysis, 5), HasSubstr("  -75.0       0      9  0.004\n"));
}

TEST(SweepReport, SaysWhatIsStillToBeJudged) {
  const auto run = [](const std::string& setting, const std::string& role, const std::string& outcomes) {
    return sweep_run({.setting = setting, .case_name = role, .role = role}, outcomes);
  };
  std::vector<NamedRun> runs = {run("a", "choose", "rr"), run("b", "choose", "uu"), run("b", "judge", "rw")};
  // The best has not been run on the case to judge by, and so is not complete.
  EXPECT_THAT(
      warnings_of(analyse_sweep(runs)),
      ElementsAre(StartsWith("1 setting without all cases, seeds or trials, marked with *"),
                  "The number to report is that of judge, where nothing was chosen: b is right in 50.0 "
                  "(9.5 to 90.5) %, with 1 of 2 trials wrong."));
}

TEST(SweepReport, OneSettingIsNotTheBestOfAny) {
  const SweepAnalysis analysis = analyse_sweep(
      {sweep_run({.setting = "", .seed = 1}, "ru"), sweep_run({.setting = "", .seed = 2}, "rr")});
  EXPECT_THAT(warnings_of(analysis), IsEmpty());
  EXPECT_THAT(text_report(analysis, 5), HasSubstr("toy: 2 runs, 1 setting, 2 seeds\n"));
  EXPECT_THAT(text_report(analysis, 5), HasSubstr("  (the experiment)       4      3"));
}

}  // namespace
}  // namespace glocal::test::sweep_report_test
