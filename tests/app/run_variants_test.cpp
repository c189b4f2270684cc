// glocal run with variants.
#include <gmock/gmock.h>

#include "app/room.hpp"

namespace glocal::test::run_variants_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

class RunVariants : public Room {
 protected:
  RunVariants() { write_variants("20000"); }

  /// Two variants; one of them draws so often.
  void write_variants(const std::string& iterations) const {
    write_experiment("trials: {every_scan: 9, max_steps: 4}\n",
                     "variants:\n"
                     "  list:\n"
                     "    paper: {}\n"
                     "    other: {localizer.matcher.ransam.iterations: " +
                         iterations + "}\n");
  }
};

TEST_F(RunVariants, EachHasAFolderAndALineOfTheTable) {
  write_variants("15000");
  const Answer answer = good(run_room("all", ""));
  const Json paper = json("all/paper/summary.json");
  const Json other = json("all/other/summary.json");
  EXPECT_EQ(paper["name"], "room");
  EXPECT_EQ(paper["trials"]["count"], other["trials"]["count"]);
  // Name, and number of trials.
  const std::string count = " +" + paper["trials"]["count"].dump() + " .*";
  EXPECT_THAT(answer.out, MatchesRegex("variant .*\npaper" + count + "\nother" + count + "\nresults in " +
                                       file("all") + "\n"));
  const std::string effective = content(file("all/other/effective.yaml"));
  EXPECT_THAT(effective, AllOf(HasSubstr("iterations: 15000"), Not(HasSubstr("variants"))));
  // The same as a run of its own.
  good(run("run " + file("all/other/effective.yaml") + " --quiet --out alone"));
  expect_same_results("alone", "all/other");
}

TEST_F(RunVariants, ResultsSayWhatSettingCaseAndSeedTheyAreOf) {
  write_experiment("",
                   "seeds: 4..5\n"
                   "choose_on: {few: {trials: {every_scan: 9, max_steps: 1}}}\n"
                   "judge_on: {more: {trials: {every_scan: 9, max_steps: 2}}}\n"
                   "variants: {list: {paper: {}, other: {localizer.matcher.ransam.iterations: 15000}}}\n");
  good(run_room("all", "--quiet --only paper_few_seed-4 --only other_more_seed-5"));
  EXPECT_EQ(json("all/paper_few_seed-4/provenance.json")["variant"].dump(),
            R"({"setting":"paper","seed":4,"case":"few","role":"choose","values":{}})");
  EXPECT_EQ(json("all/other_more_seed-5/provenance.json")["variant"].dump(),
            R"({"setting":"other","seed":5,"case":"more","role":"judge",)"
            R"("values":{"localizer.matcher.ransam.iterations":"15000"}})");
  EXPECT_EQ(json("all/other_more_seed-5/summary.json")["seed"], 5);
  EXPECT_THAT(refusal(run_room("all", "--seed 4")),
              HasSubstr("--set seed=4: error: seed: the experiment has `seeds`; leave one out"));
}

TEST_F(RunVariants, OnlyThoseThatAreNamed) {
  good(run_room("all", "--quiet --only other"));
  EXPECT_TRUE(fs::exists("all/other/summary.json"));
  EXPECT_FALSE(fs::exists("all/paper"));
  EXPECT_EQ(refusal(run_room("none", "--only papr --only other")),
            "--only papr: error: no such variant (did you mean 'paper'?)\n1 error\n");
  EXPECT_FALSE(fs::exists("none"));
}

TEST_F(RunVariants, WhatIsFinishedIsKeptIfItIsTheSame) {
  good(run_room("all", "--quiet --only paper"));
  const auto written = fs::last_write_time("all/paper/summary.json");
  const Answer answer = good(run_room("all", ""));
  EXPECT_THAT(answer.err, AllOf(HasSubstr("paper: kept, as an earlier run has finished it"),
                                Not(HasSubstr("other: kept"))));
  EXPECT_EQ(fs::last_write_time("all/paper/summary.json"), written);

  // Another variant has changed since, and it alone is in the way.
  write_variants("18000");
  EXPECT_EQ(refusal(run_room("all", "--quiet")),
            file("all/other") +
                ": error: output: the folder has results of another run: it is of other values "
                "(effective.yaml); choose another folder with --out, or replace earlier results "
                "with --force\n1 error\n");
  good(run_room("all", "--quiet --force"));
  EXPECT_EQ(fs::last_write_time("all/paper/summary.json"), written);
  EXPECT_THAT(content(file("all/other/effective.yaml")), HasSubstr("iterations: 18000"));
}

TEST_F(RunVariants, ABadVariantLeavesNothingOfAny) {
  write_variants("0");
  EXPECT_EQ(refusal(run_room("all")),
            file("room.yaml") +
                ":10:50: error: localizer.matcher.ransam: iterations: 0 is out of range, must be "
                ">= 1 and <= 100000000\n1 error\n");
  write_experiment("trials: {every_scan: 9}\n",
                   "variants: {list: {paper: {}, none: {trials.min_steps: 100000}}}\n");
  EXPECT_THAT(refusal(run_room("all")), HasSubstr("error: variant 'none': trials: none of "));
  EXPECT_FALSE(fs::exists("all"));
}

TEST_F(RunVariants, AVariantWithAnotherDriveSaysSo) {
  write_experiment("trials: {every_scan: 9, max_steps: 2}\n", "variants: {grid: {seed: [1, 2]}}\n");
  const Answer answer = good(run_room("all", ""));
  EXPECT_THAT(answer.err, HasSubstr("seed-2: has a seed, a map, observations or trials of its own"));
  EXPECT_EQ(json("all/seed-2/summary.json")["seed"], 2);
  EXPECT_NE(lines("all/seed-1/steps.jsonl"), lines("all/seed-2/steps.jsonl"));
  // Its drive is its own: the same as if it were run alone.
  good(run_room("alone", "--quiet --seed 2 --set variants={}"));
  expect_same_results("alone", "all/seed-2");
}

TEST_F(RunVariants, OnesThatTheFileHasNoLongerAreNamed) {
  write_experiment("trials: {whole: true, max_steps: 2}\n", "variants: {grid: {seed: [1, 2]}}\n");
  EXPECT_THAT(good(run_room("all")).err, Not(HasSubstr("not in the file")));
  EXPECT_THAT(good(run_room("all", "--quiet --only seed-2")).err, Not(HasSubstr("not in the file")));
  write_experiment("trials: {whole: true, max_steps: 2}\n", "variants: {grid: {seed: [1, 3]}}\n");
  EXPECT_THAT(
      good(run_room("all")).err,
      HasSubstr("all/seed-2: results of a variant that is not in the file: compare, sweep and report"));
}

TEST_F(RunVariants, ResultsWithoutVariantsAreNotMixedWithThem) {
  good(run_room("all", "--quiet --set variants={}"));
  EXPECT_THAT(refusal(run_room("all", "--force")),
              HasSubstr("the folder has results of a run without variants"));
}

TEST_F(RunVariants, AreCheckedWithoutRunningThem) {
  const Answer answer = good(run("check room.yaml"));
  EXPECT_THAT(answer.out, MatchesRegex(".*: ok, .* trials of each of 2 variants\n"));
  write_experiment("trials: {every_scan: 9, max_steps: 6}\n",
                   "variants: {list: {few: {}, many: {trials.every_scan: 4}}}\n");
  good(run_room("counted"));
  const auto trials = [&](const std::string& variant) {
    return json("counted/" + variant + "/summary.json")["trials"]["count"].get<int>();
  };
  EXPECT_THAT(run("check room.yaml").out,
              HasSubstr(std::to_string(trials("few") + trials("many")) + " trials of 2 variants\n"));
}

}  // namespace
}  // namespace glocal::test::run_variants_test
