// glocal sweep.
#include <gmock/gmock.h>

#include "app/result_lines.hpp"
#include "app/room.hpp"

namespace glocal::test::sweep_command_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A trial each: r, w or u; right ones take 3 steps.
std::vector<nlohmann::json> outcomes(const std::string& letters) {
  std::vector<nlohmann::json> trials;
  for (const char letter : letters) {
    const char* name = letter == 'r' ? "right" : letter == 'w' ? "wrong" : "undecided";
    trials.push_back({{"outcome", name}, {"steps", 3}});
  }
  return trials;
}

class SweepCommand : public Room {
 protected:
  SweepCommand() {
    write_experiment("",
                     "variants:\n"
                     "  grid:\n"
                     "    localizer.matcher.ransam.iterations: [100, 200]\n"
                     "    localizer.matcher.ransam.min_side: [0.5, 1]\n"
                     "choose_on: {near: {trials: {every_scan: 9, max_steps: 1}}}\n"
                     "judge_on: {far: {trials: {every_scan: 8, max_steps: 1}}}\n"
                     "seeds: 1..2\n"
                     "output: {steps: false, maps: none}\n");
    good(run_room("all"));
  }

  /// Puts these outcomes in place of those of all seeds of a setting.
  void set_outcomes(const std::string& setting, const std::string& near, const std::string& far) const {
    for (const char* seed : {"_seed-1", "_seed-2"}) {
      replace_lines(file("all/" + setting + "_near" + seed), outcomes(near), {});
      replace_lines(file("all/" + setting + "_far" + seed), outcomes(far), {});
    }
  }

  void set_all_outcomes() const {
    set_outcomes("iterations-100_min_side-0.5", "ruuu", "uu");
    set_outcomes("iterations-100_min_side-1", "rruu", "ru");
    set_outcomes("iterations-200_min_side-0.5", "rrru", "uu");
    set_outcomes("iterations-200_min_side-1", "rrrw", "rr");
  }
};

TEST_F(SweepCommand, TellsWhatIsBestAndWhyAndWhatToReport) {
  set_all_outcomes();
  const Answer answer = good(run("sweep all"));
  EXPECT_EQ(answer.err, "");
  EXPECT_THAT(answer.out, HasSubstr("room: 16 runs, 4 settings, 2 seeds, 2 cases\n"));
  // Twice 3 of 4 right, twice the same: Wilson's interval of 3 of 4.
  EXPECT_THAT(answer.out, HasSubstr("  setting                      trials  right  wrong  undecided          "
                                    "    %, 95 %  score  steps  ahead  better  worse      p\n"
                                    "  iterations-200_min_side-0.5       8      6      0          2  75.0 "
                                    "(30.1 to 95.4)   75.0      3  +50.0       2      0  0.500\n"));
  EXPECT_THAT(
      answer.out,
      HasSubstr("iterations-200_min_side-1         8      6      2          0  75.0 (30.1 to 95.4)   50.0"));
  EXPECT_THAT(answer.out,
              HasSubstr("localizer.matcher.ransam.iterations: 37.5 points from the worst to the best; rank "
                        "correlation +0.94\n"));
  EXPECT_THAT(answer.out, HasSubstr("  iterations \\ min_side       0.5         1\n"
                                    "  100                    25 #....  50 ###..\n"
                                    "  200                    75 ####.  75 ####.\n"));
  EXPECT_THAT(answer.out, AllOf(HasSubstr("was chosen among 4 settings"),
                                HasSubstr("The number to report is that of far")));
  EXPECT_THAT(answer.out, Not(HasSubstr("*:")));
}

TEST_F(SweepCommand, HasAllNumbersAsJson) {
  set_all_outcomes();
  const Answer answer = good(run("sweep all --json --map min_side iterations"));
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["settings"][0]["setting"], "iterations-200_min_side-0.5");
  EXPECT_EQ(json["settings"][0]["values"]["localizer.matcher.ransam.iterations"], "200");
  EXPECT_EQ(json["settings"][0]["judged"]["right"], 0);
  EXPECT_EQ(json["settings"][1]["judged"]["right"], 2 * 1);
  EXPECT_EQ(json["map"]["rows"]["label"], "min_side");
  EXPECT_EQ(json["map"]["cells"][1][0]["success_rate"]["value"], 0.5);
  EXPECT_EQ(json["chance"]["places"], 4);
  EXPECT_EQ(json["chance"]["baseline"], "iterations-100_min_side-0.5");
  EXPECT_EQ(json["settings"][0]["over_baseline"]["lead"], 0.5);
  EXPECT_EQ(json["choose_on"].dump(), R"(["near"])");
  EXPECT_EQ(run("sweep all --json --map min_side iterations").out, answer.out);
}

TEST_F(SweepCommand, MarksWhatIsIncomplete) {
  set_all_outcomes();
  fs::remove_all("all/iterations-200_min_side-0.5_near_seed-2");
  const Answer answer = good(run("sweep all --top 1"));
  EXPECT_THAT(answer.out, AllOf(HasSubstr("1 setting without all cases, seeds or trials, marked with *"),
                                HasSubstr("\n  3 settings more; --top 4 shows all.\n")));
  EXPECT_THAT(run("sweep all").out, HasSubstr("  iterations-200_min_side-0.5 * "));
}

TEST_F(SweepCommand, SaysWhatToDoWithOtherFolders) {
  write_experiment("trials: {every_scan: 9, max_steps: 1}\n");
  good(run_room("alone"));
  EXPECT_EQ(refusal(run("sweep " + file("alone"))),
            file("alone/provenance.json") +
                ": error: does not say which setting these results are of; name a folder that glocal run "
                "has left of an experiment with methods, variants, seeds or cases\n1 error\n");
  EXPECT_EQ(run("sweep nowhere").exit_code, 2);
  EXPECT_THAT(run("sweep all --baseline best").err,
              HasSubstr("--baseline best: error: there is no such setting"));
  EXPECT_THAT(refusal(run("sweep all --map iteration min_side")),
              HasSubstr("--map iteration: error: no such parameter varies"));
  EXPECT_EQ(run("sweep all --top -1").exit_code, 2);
  EXPECT_EQ(run("sweep all --top 3 --json").exit_code, 2);
}

}  // namespace
}  // namespace glocal::test::sweep_command_test
