// What is said of a sweep in words.
#include "evaluation/sweeps/sweep_report.hpp"

#include <gmock/gmock.h>

#include "evaluation/sweeps/runs.hpp"

namespace glocal::test::sweep_report_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(SweepReport, TellsChanceFromMore) {
  std::vector<NamedRun> runs = {sweep_run({"a"}, "rrrrrrrrrrrr"), sweep_run({"b"}, "uuuuuuuuuuuu")};
  EXPECT_THAT(
      warnings_of(analyse_sweep(runs)),
      ElementsAre(HasSubstr("So there is more to it than chance"),
                  "Judge the best by other logs or worlds (judge_on), and report what comes of that."));
  runs = {sweep_run({"a"}, "rru"), sweep_run({"b"}, "urr")};
  EXPECT_THAT(
      warnings_of(analyse_sweep(runs)).front(),
      StartsWith("a, the first of 2 with the same score and steps, was chosen among 2 settings by the very "
                 "trials that its numbers are of, so they flatter it. Its score is 0.0 points over"));
  EXPECT_THAT(warnings_of(analyse_sweep(runs)).front(), HasSubstr("So all settings may be equally good."));
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
