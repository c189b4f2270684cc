// glocal compare.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "app/result_lines.hpp"
#include "app/room.hpp"

namespace glocal::test::compare_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CompareCommand : public CommandLine {
 protected:
  CompareCommand() {
    write_world();
    std::ofstream(file("room.yaml")) << "schema: 1\n"
                                        "name: room\n"
                                        "map: {simulation: {world: world.yaml}}\n"
                                        "observations: {simulation: {world: world.yaml}}\n"
                                        "trials: {every_scan: 2, max_steps: 8}\n"
                                        "localizer:\n"
                                        "  matcher: indexed_ransam\n"
                                        "  threshold_policy: {fixed: {omega_max: 0.1}}\n"
                                        "  verdict_rule: staged_margin\n"
                                        "output: {maps: none}\n";
  }

  void run_room(const std::string& out, const std::string& options = "") const {
    good(run("run " + file("room.yaml") + " --quiet --out " + file(out) + " " + options));
  }

  /// One with a threshold that nothing reaches.
  void run_both() const {
    run_room("all/some");
    run_room("all/none", "--set localizer.threshold_policy.fixed.omega_max=1");
  }

  void expect_refused(const std::string& arguments, const std::string& why) const {
    const Answer answer = run("compare " + arguments + " -o " + file("refused.json"));
    EXPECT_EQ(answer.exit_code, 2) << arguments;
    EXPECT_EQ(answer.out, "") << arguments;
    EXPECT_THAT(answer.err, HasSubstr(why)) << arguments;
    EXPECT_FALSE(fs::exists(file("refused.json"))) << arguments;
  }
};

TEST_F(CompareCommand, ComparesWhatRunHasLeft) {
  run_both();
  const std::string command = "compare all/some all/none --force -o c.json -o c.csv -o c.md";
  const Answer answer = good(run(command));
  EXPECT_EQ(answer.err, "");
  const json comparison = json::parse(content("c.json"));
  const json some = json::parse(content("all/some/summary.json"));
  const json none = json::parse(content("all/none/summary.json"));
  // The figures of each run are those of its own summary.
  ASSERT_EQ(comparison["starts"], some["trials"]["count"]);
  for (const auto& [run, summary] :
       {std::pair{comparison["methods"][0], some}, {comparison["methods"][1], none}}) {
    EXPECT_EQ(run["right"], summary["trials"]["right"]);
    EXPECT_EQ(run["wrong"], summary["trials"]["wrong"]);
    // One trial at each place: but for rounding the interval of independent ones.
    for (const char* bound : {"value", "low", "high"})
      EXPECT_NEAR(run["success_rate"][bound].get<double>(), summary["success_rate"][bound].get<double>(),
                  1e-12);
  }
  EXPECT_EQ(comparison["methods"][0]["medians"]["steps"], some["steps_to_localize"]["median"]);
  // What is right in one of them is not in the other: 2 / 2^n.
  const auto n = some["trials"]["right"].get<int>();
  ASSERT_EQ(none["trials"]["right"], 0);
  ASSERT_GE(n, 6);
  EXPECT_EQ(comparison["pairs"][0]["outcomes"][1]["p"], std::ldexp(2.0, -n));
  // Whether times differ, too, is another matter.
  const auto conclusion = comparison["pairs"][0]["conclusion"].get<std::string>();
  EXPECT_THAT(conclusion, HasSubstr("none is worse than some: right less often (-"));
  EXPECT_THAT(answer.out,
              AllOf(HasSubstr("  none is worse than some: "), Not(HasSubstr("none against some\n"))));
  EXPECT_THAT(run("compare --full all/some all/none").out,
              AllOf(HasSubstr("none against some\n"), HasSubstr("How to read this\n")));
  EXPECT_THAT(content("c.md"), HasSubstr("## none against some"));
  EXPECT_THAT(content("c.csv"), HasSubstr("none,some,right,"));

  const std::string text = content("c.json") + content("c.csv") + content("c.md");
  const Answer again = run(command);
  EXPECT_EQ(again.out, answer.out);
  EXPECT_EQ(content("c.json") + content("c.csv") + content("c.md"), text);
}

TEST_F(CompareCommand, TakesAFolderOfVariantsAndAnyBaseline) {
  run_both();
  Answer answer = good(run("compare all"));
  EXPECT_THAT(answer.out, HasSubstr("1 method compared with none, "));
  answer = good(run("compare all/ --baseline some"));
  EXPECT_THAT(answer.out, HasSubstr("1 method compared with some, "));
}

TEST_F(CompareCommand, TellsFoldersOfOneNameApart) {
  run_room("a/1");
  run_room("b/1", "--set name=other");
  const Answer answer = good(run("compare a/1 " + file("b/1") + " --baseline other"));
  EXPECT_THAT(answer.out, HasSubstr("1 method compared with " + file("b/1") + ", "));
}

TEST_F(CompareCommand, FindsNothingBetweenARunAndItself) {
  run_room("a");
  run_room("b");
  const Answer answer = good(run("compare a b -o c.json"));
  EXPECT_THAT(answer.out, Not(HasSubstr("better than a")));
  const json comparison = json::parse(content("c.json"));
  for (const json& outcome : comparison["pairs"][0]["outcomes"]) EXPECT_EQ(outcome["p"], 1.0);
  EXPECT_EQ(comparison["pairs"][0]["measures"][0]["differing_places"], 0);
}

TEST_F(CompareCommand, SaysTheSameOfRunsWithTheSameSeedIfTimesAreLeftOut) {
  run_both();
  const Answer first = good(run("compare --no-times all"));
  fs::rename("all", "before");
  run_both();
  const Answer second = run("compare --no-times all");
  EXPECT_EQ(first.out, second.out);
  EXPECT_THAT(run("compare all").out, HasSubstr("CPU, ms"));
  EXPECT_THAT(first.out, AllOf(HasSubstr("steps"), Not(HasSubstr("CPU, ms"))));
}

TEST_F(CompareCommand, TakesTimesAnewAndInTurn) {
  run_room("a", "--jobs 2");
  run_room("b", "--set localizer.matcher.ransam.iterations=200000");
  const std::string both = "a b -o c.json";
  EXPECT_THAT(run("compare " + both).out,
              HasSubstr("Times of b and a are not compared: --jobs 1, and --jobs 2."));
  // As of shards with several numbers of threads; what is run anew has that of the experiment.
  json provenance = json::parse(content("b/provenance.json"));
  provenance["threads"] = 0;
  folder_.write("b/provenance.json", provenance.dump());
  const Answer answer = good(run("compare --time --force " + both));
  EXPECT_THAT(answer.out, Not(HasSubstr("are not compared")));
  const json measures = json::parse(content("c.json"))["pairs"][0]["measures"];
  const json& time = measures.back();
  EXPECT_EQ(time["measure"], "step_cpu_ms");
  // Drawing takes longer than looking up in an index.
  EXPECT_GT(time["mean_difference"]["low"], 0.0);
  EXPECT_EQ(time["matters"], true);
}

TEST_F(CompareCommand, RefusesTimesOfWhatAnswersOtherwiseNow) {
  run_room("a");
  run_room("b", "--set localizer.matcher.ransam.iterations=50");
  // As if b had been run with other values than it says.
  fs::copy_file("a/effective.yaml", file("b/effective.yaml"), fs::copy_options::overwrite_existing);
  EXPECT_THAT(refusal(run("compare --time a " + file("b"))),
              AllOf(HasSubstr(file("b") + ": error: trial "), HasSubstr("run it anew")));
  // A file that is in the way is told before anything is run.
  folder_.write("old.md", "kept");
  EXPECT_THAT(refusal(run("compare --time a " + file("b") + " -o old.md")),
              HasSubstr("old.md: error: the file exists"));
  EXPECT_EQ(run("compare --time --no-times a " + file("b")).exit_code, 2);
}

TEST_F(CompareCommand, WarnsOfRunsThatDiffer) {
  run_room("a");
  run_room("b", "--seed 2 --set evaluation.max_translation_error=0.2 --set map.simulation.resolution=0.1");
  good(run("compare a b -o c.json"));
  const std::string warnings = json::parse(content("c.json"))["warnings"].dump();
  EXPECT_THAT(warnings, HasSubstr("evaluation.max_translation_error: 0.2 instead of 0.5"));
  EXPECT_THAT(warnings, HasSubstr("map.simulation.resolution: 0.1 instead of"));
  EXPECT_THAT(warnings, HasSubstr("b has seed 2 and a seed 1"));
  EXPECT_THAT(warnings, HasSubstr("Few places"));
  EXPECT_THAT(warnings, Not(HasSubstr("other observations")));
}

TEST_F(CompareCommand, WarnsOfAWorldThatHasChanged) {
  run_room("a");
  std::ofstream(file("world.yaml"), std::ios::app) << "circles: [{centre: [2, 1], radius: 0.2}]\n";
  run_room("b");
  good(run("compare a b -o c.json"));
  EXPECT_THAT(json::parse(content("c.json"))["warnings"].dump(),
              AllOf(HasSubstr("map.simulation.world: " + file("world.yaml") + " has changed"),
                    HasSubstr("observations.simulation.world: ")));
}

TEST_F(CompareCommand, RefusesWhatCannotBeCompared) {
  run_room("a");
  run_room("b");
  fs::create_directory("empty");
  expect_refused("a", "there is nothing to compare it with");
  expect_refused("a b a/../a", "is named twice");
  expect_refused("a empty", "empty: error: holds no results");
  expect_refused("a missing", "missing: error: is no folder");
  expect_refused("a b --baseline c", "--baseline c: error: names none");
  // Both are of the experiment "room".
  expect_refused("a b --baseline room", "or more than one, of the methods");
  fs::remove("b/trials.jsonl");
  expect_refused("a b", "b/trials.jsonl: error: cannot be read");
  run_room("later", "--set 'trials={starts_m: [0.4], max_steps: 5}'");
  expect_refused("a later", "none of its 1 starts is one of all runs");
}

TEST_F(CompareCommand, ReportsTheFaultsOfAllFolders) {
  fs::create_directory("empty");
  EXPECT_THAT(refusal(run("compare empty missing")),
              AllOf(HasSubstr("holds no results"), HasSubstr("is no folder"), HasSubstr("2 errors")));
}

TEST_F(CompareCommand, PrintsAsJsonWhatItWrites) {
  run_both();
  const std::string command = "compare all --no-times ";
  const Answer printed = good(run(command + "--json"));
  good(run(command + "-o c.json"));
  EXPECT_EQ(printed.out, content("c.json"));
  EXPECT_THAT(refusal(run(command + "-o c.txt")), HasSubstr("end it with .json, .csv or .md"));
}

TEST_F(CompareCommand, ReplacesNoFileUnlessForced) {
  run_room("a");
  run_room("b");
  const std::string command = "compare a b -o new.csv -o ";
  std::ofstream("old.json") << "kept";
  EXPECT_THAT(refusal(run(command + "old.json")), HasSubstr("the file exists"));
  EXPECT_EQ(content("old.json"), "kept");
  EXPECT_FALSE(fs::exists("new.csv"));
  good(run(command + "old.json --force"));
  EXPECT_TRUE(json::accept(content("old.json")));
}

class CompareVariants : public Room {};

TEST_F(CompareVariants, TellsWhatOneOrTwoParametersDo) {
  write_experiment("trials: {every_scan: 9, max_steps: 1}\n",
                   "variants:\n"
                   "  grid:\n"
                   "    localizer.matcher.ransam.iterations: [200, 100]\n"
                   "    localizer.matcher.ransam.min_side: [0.5, 1]\n"
                   "output: {steps: false, maps: none}\n");
  good(run_room("all"));
  const auto set_outcomes = [&](const std::string& setting, const std::string& outcome, int steps) {
    replace_lines("all/" + setting, {{{"outcome", outcome}, {"steps", steps}}}, {});
  };
  set_outcomes("iterations-200_min_side-0.5", "right", 4);
  set_outcomes("iterations-200_min_side-1", "right", 6);
  set_outcomes("iterations-100_min_side-0.5", "right", 9);
  set_outcomes("iterations-100_min_side-1", "wrong", 7);
  const Answer answer = good(run("compare --full all -o all.json -o all.md"));
  EXPECT_THAT(answer.out, HasSubstr("3 methods compared with iterations-200_min_side-0.5, "));
  EXPECT_THAT(answer.out,
              HasSubstr("localizer.matcher.ransam.iterations: 50.0 points from the worst to the best"));
  // Of right trials, and of their steps.
  EXPECT_THAT(answer.out, HasSubstr("iterations \\ min_side        0.5          1\n"));
  EXPECT_THAT(answer.out, HasSubstr("  100                    100 #####    0 .....\n"));
  EXPECT_THAT(answer.out, HasSubstr("  200                      4  6\n"));
  EXPECT_THAT(content("all.md"), HasSubstr("Right trials, %, by two parameters"));
  const nlohmann::json parameters = nlohmann::json::parse(content("all.json")).at("parameters");
  EXPECT_EQ(parameters["effects"][0]["levels"][0]["label"], "100");
  EXPECT_EQ(parameters["effects"][0]["levels"][0]["wrong"], 1);
  EXPECT_EQ(parameters["effects"][0]["levels"][1]["median_steps"], 5.0);
  EXPECT_EQ(parameters["map"]["cells"][0][0]["median_steps"], 9.0);
}

TEST_F(CompareVariants, PairsMethodsWithinCaseAndSeed) {
  folder_.write("few.yaml", "localizer: {matcher: {ransam: {iterations: 500}}}\n");
  folder_.write("many.yaml", "localizer: {matcher: {ransam: {iterations: 5000}}}\n");
  for (const char* name : {"near.yaml", "far.yaml"})
    folder_.write(name,
                  "map: {simulation: {world: world.yaml}}\n"
                  "observations: {simulation: {world: world.yaml}}\n"
                  "trials: {every_scan: 9, max_steps: 1}\n");
  const std::string options =
      "run --quiet --method few.yaml --method many.yaml --case near.yaml --case far.yaml --set "
      "output.maps=none --set output.steps=false --seeds 1..2 --out r";
  good(run(options));
  for (const char* one_case : {"near", "far"}) {
    for (const char* seed : {"1", "2"}) {
      const auto results = [&](const std::string& method) {
        return "r/" + method + "_" + one_case + "_seed-" + seed;
      };
      const nlohmann::json right = {{"outcome", "right"}, {"steps", 4}};
      const nlohmann::json undecided = {{"outcome", "undecided"}, {"steps", 4}};
      replace_lines(results("few"), std::vector<nlohmann::json>(4, undecided), {});
      replace_lines(results("many"), std::vector<nlohmann::json>(4, right), {});
    }
  }
  const Answer answer = good(run("compare --no-times r"));
  EXPECT_THAT(answer.out,
              HasSubstr("1 method compared with few, by 16 starts: 8 places of 2 cases, 2 seeds\n"));
  // 2 / 2^8: seeds are no places.
  EXPECT_THAT(answer.out, HasSubstr("many is better than few: right more often (+100.0 points, "));
  EXPECT_THAT(answer.out, HasSubstr("p = 0.008)."));
  fs::remove_all("r/few_far_seed-2");
  EXPECT_THAT(run("compare --no-times r --baseline many").out,
              AllOf(HasSubstr("1 method compared with many, by 12 starts"),
                    HasSubstr("! Left out, as not all methods have them: far with seed 2 (only many).")));
}

}  // namespace
}  // namespace glocal::test::compare_test
