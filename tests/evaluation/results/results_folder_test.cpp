#include "evaluation/results/results_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "files.hpp"
#include "glocal/error.hpp"

namespace glocal::test::results_folder_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A folder as glocal run leaves it, with two trials.
class ResultsFolder : public testing::Test {
 protected:
  ResultsFolder() { write_results("run"); }

  void write_results(const std::string& name) const {
    fs::create_directory(temporary_.path() / name);
    write_summary(name, 2, 3);
    temporary_.write(name + "/provenance.json",
                     R"({"host": "h", "cpu": "c", "threads": 2, "inputs_sha256": {"/lab.log": "abc"}})");
    temporary_.write(name + "/effective.yaml",
                     "seed: 7\nmap:\n  carmen_log:\n    path: \"/lab.log\"\n    segments: [[0, 0.5]]\n"
                     "output:\n  steps: true\n  maps: none\n");
    temporary_.write(
        name + "/trials.jsonl",
        R"({"trial":0,"start":{"sample":0,"distance_m":0.0,"stamp":5.5,"reference":{"x":1,"y":2,"theta":0.5}},)"
        R"("outcome":"right","steps":3,"distance_m":1.25,"translation_error_m":0.1,"rotation_error_deg":2})"
        "\n"
        R"({"trial":1,"start":{"sample":9,"distance_m":6.5,"stamp":8},"outcome":"failed","steps":0,"distance_m":0})"
        "\n");
    temporary_.write(name + "/steps.jsonl", step(0, 1) + step(1, 5) + step(2, 3));
  }

  void write_summary(const std::string& name, int trials, int steps) const {
    temporary_.write(
        name + "/summary.json",
        fmt::format(
            R"({{"name": "lab", "seed": 7, "complete": true, "trials": {{"count": {}, "right": 1, "wrong": 0, "undecided": 0}},)"
            "\n"
            R"("steps": {}}})",
            trials, steps));
  }

  /// Of trial 0; `more` are further keys.
  static std::string step(int number, int match_ms, const std::string& more = "") {
    return fmt::format(
        R"({{"trial":0,"step":{},"stage_ms":{{"local_map":0.5,"match":{},"cluster":0.25,"rate":0.25}},)"
        R"("stage_cpu_ms":{{"local_map":0.5,"match":{},"cluster":0.25,"rate":0.25}}{}}})"
        "\n",
        number, match_ms, match_ms + 10, more);
  }

  [[nodiscard]] fs::path folder() const { return temporary_.path() / "run"; }

  /// What is said of the folder when it is read.
  [[nodiscard]] std::string fault() const {
    return error_of([&] { return read_results(folder()); });
  }

  TemporaryFolder temporary_;
};

TEST_F(ResultsFolder, IsReadWithTheTimesOfItsSteps) {
  const StoredRun results = read_results(folder());
  EXPECT_EQ(results.experiment, "lab");
  EXPECT_EQ(results.seed, 7U);
  EXPECT_TRUE(results.complete);
  EXPECT_EQ(results.machine, (Machine{"h", "c", 2}));
  ASSERT_EQ(results.trials.size(), 2U);
  const auto& [start, right] = *results.trials.begin();
  EXPECT_EQ(start.sample, 0);
  EXPECT_EQ(start.stamp, 5.5);
  EXPECT_EQ(right.outcome, Outcome::right);
  EXPECT_EQ(right.steps, 3.0);
  EXPECT_EQ(right.distance_m, 1.25);
  EXPECT_EQ(right.translation_error_m, 0.1);
  EXPECT_EQ(right.rotation_error_deg, 2.0);
  ASSERT_TRUE(right.start_reference);
  EXPECT_EQ(right.start_reference->y, 2.0);
  EXPECT_EQ(right.step_cpu_ms, 14.0);  // Of 12, 16 and 14.
  const TrialResult& failed = results.trials.at({9, 6.5, 8.0});
  EXPECT_EQ(failed.outcome, Outcome::failed);
  EXPECT_EQ(failed.step_cpu_ms, std::nullopt);
  EXPECT_EQ(failed.translation_error_m, std::nullopt);
}

TEST_F(ResultsFolder, KnowsItsSettingsByPathAndItsFilesByContent) {
  const auto settings = read_results(folder()).settings;
  EXPECT_EQ(settings.at("seed").text, "7");
  EXPECT_EQ(settings.at("map.carmen_log.segments[0][1]").identity, "0.5");
  EXPECT_EQ(settings.at("map.carmen_log.path").text, "/lab.log");
  EXPECT_EQ(settings.at("map.carmen_log.path").identity, "abc");
}

TEST_F(ResultsFolder, NeedsNoStepsIfTheRunWroteNone) {
  fs::remove(folder() / "steps.jsonl");
  EXPECT_THAT(fault(), HasSubstr("steps.jsonl: error: cannot be read"));
  temporary_.write("run/effective.yaml", "output: {steps: false, maps: none}\n");
  const StoredRun results = read_results(folder());
  EXPECT_FALSE(results.has_steps);
  EXPECT_EQ(results.trials.begin()->second.step_cpu_ms, std::nullopt);
  EXPECT_THAT(
      config_error(folder(), [&] { require_steps(results); }),
      HasSubstr("steps.jsonl: error: is not there; run the experiment again with --set output.steps=true"));
}

TEST_F(ResultsFolder, HandsOverEveryLine) {
  std::vector<int> trials, steps;
  static_cast<void>(read_results(folder(), {[&](const auto& trial) { trials.push_back(trial.at("trial")); },
                                            [&](const auto& step) {
                                              EXPECT_EQ(trials.size(), 2U);
                                              steps.push_back(step.at("step"));
                                            }}));
  EXPECT_THAT(trials, ElementsAre(0, 1));
  EXPECT_THAT(steps, ElementsAre(0, 1, 2));
  const auto refuse = [](const auto&) { throw std::invalid_argument("not this one"); };
  EXPECT_THAT(config_error(folder(), [&] { static_cast<void>(read_results(folder(), {.step = refuse})); }),
              HasSubstr("steps.jsonl:1: error: is no line of results (not this one)"));
}

TEST_F(ResultsFolder, TimesAreReadWithoutTheRestOfTheSteps) {
  const std::string rest = R"(,"best":[{"pose":{"x":1}}])";
  temporary_.write("run/steps.jsonl", step(0, 1, rest) + step(1, 5, rest) + step(2, 3, rest));
  std::size_t keys = 0;
  const StoredRun run =
      read_results(folder(), {.step = [&](const auto& line) { keys += line.size(); }}, ResultParts::times);
  EXPECT_EQ(keys, 3U * 4U);
  EXPECT_EQ(run.trials.begin()->second.step_cpu_ms, 14.0);
  EXPECT_EQ(read_results(folder(), {}, ResultParts::all_but_steps).trials.begin()->second.step_cpu_ms,
            std::nullopt);
  // A line that is cut off is found all the same.
  temporary_.write("run/steps.jsonl", step(0, 1, rest) + step(1, 5, rest) + step(2, 3).substr(0, 150) + "\n");
  EXPECT_THAT(
      config_error(folder(), [&] { static_cast<void>(read_results(folder(), {}, ResultParts::times)); }),
      HasSubstr("steps.jsonl:3: error: is no line of results"));
}

TEST_F(ResultsFolder, MissesItsFilesByName) {
  for (const char* file : {"trials.jsonl", "effective.yaml", "provenance.json", "summary.json"}) {
    fs::remove(folder() / file);
    EXPECT_THAT(fault(), AllOf(HasSubstr(file), HasSubstr("cannot be read; name a folder that glocal run")))
        << file;
  }
}

std::string start_of(int trial, int sample) {
  return fmt::format(
      R"({{"trial":{},"start":{{"sample":{},"distance_m":0,"stamp":0}},"steps":0,"distance_m":0,"outcome":)",
      trial, sample);
}

TEST_F(ResultsFolder, NamesTheLineOfTrialsThatIsWrong) {
  const std::string trial = start_of(0, 0) + "\"right\"}\n";
  for (const auto& [text, what] : {
           std::pair<std::string, std::string>{trial + "{\n", "2: error: is no line of results (parse error"},
           {start_of(0, 0) + "\"rigth\"}\n", "1: error: is no line of results (there is no outcome 'rigth')"},
           {trial + start_of(1, 0) + "\"wrong\"}\n",
            "2: error: is no line of results (an earlier trial starts at"},
           {trial + start_of(0, 5) + "\"wrong\"}\n",
            "2: error: is no line of results (trial 0 is there already"},
           {"[]\n", "1: error: is no line of results"},
           {trial + start_of(1, 5) + "3}\n", "2: error: is no line of results"},
           {trial,
            "1: error: ends here with 1 trials, where summary.json counts 2; run the experiment again"},
           {"", "1: error: ends here with 0 trials, where summary.json counts 2"},
       }) {
    temporary_.write("run/trials.jsonl", text);
    EXPECT_THAT(fault(), HasSubstr("trials.jsonl:" + what)) << text;
  }
}

TEST_F(ResultsFolder, NamesTheLineOfStepsThatIsWrong) {
  const std::string two = step(0, 1) + step(1, 1);
  for (const auto& [text, what] : {
           std::pair<std::string, std::string>{two + step(2, 1).substr(0, 40),
                                               "3: error: is no line of results"},
           {"", "1: error: ends here with 0 of the 3 steps of trial 0; run the experiment again"},
           {two, "2: error: ends here with 2 of the 3 steps of trial 0"},
           {two + step(2, 1) + step(3, 1), "4: error: ends here with 4 steps, where summary.json counts 3"},
           {step(0, 1) + step(2, 1),
            "2: error: is no line of results (step 2 of trial 0 is here, where step 1"},
           {R"({"trial": 7})", "1: error: is no line of results (trials.jsonl has no trial 7)"},
           {R"({"trial": 0, "step": 0})", "1: error: is no line of results (key 'stage_ms' not found)"},
           {two + step(2, 1, R"(,"collisions":4)"),
            "3: error: is no line of results (it is of an earlier version: "
            "'collisions' is called 'proposals' now); run the experiment "
            "again with this version"},
           {step(0, 1, R"(,"checks":4)"),
            "1: error: is no line of results (it is of an earlier version: 'checks' is "
            "called 'points_tested' now)"},
           {step(0, 1, R"(,"evidence":{"conflict":0.5})"),
            "1: error: is no line of results (it is of an earlier "
            "version: 'conflict' is called 'free_space_violation' now)"},
       }) {
    temporary_.write("run/steps.jsonl", text);
    EXPECT_THAT(fault(), HasSubstr("steps.jsonl:" + what)) << text;
  }
}

TEST_F(ResultsFolder, NamesThePlaceInOtherFiles) {
  for (const auto& [name, text, what] : {
           std::tuple<const char*, std::string, std::string>{
               "summary.json", "", ":1: error: is not as glocal run leaves it (parse error"},
           {"summary.json", "{\"name\": \"lab\",\n\"seed\": ", ":2: error: is not as glocal run leaves it"},
           {"summary.json", "{\"name\": 3}", ": error: is not as glocal run leaves it"},
           {"provenance.json", "{\n\n", ":3: error: is not as glocal run leaves it"},
           {"effective.yaml", "", "effective.yaml:"},
           {"effective.yaml", "seed: [\n", "effective.yaml:"},
           {"effective.yaml", "seed: 7\nmap:\n  carmen_log:\n", ":4: error: is cut off"},
           {"effective.yaml", "seed: 7\noutput:\n  steps: true\n  maps: no", ":4: error: is cut off"},
       }) {
    write_results("run");
    temporary_.write(std::string("run/") + name, text);
    EXPECT_THAT(fault(), AllOf(HasSubstr(name), HasSubstr(what))) << text;
  }
}

TEST_F(ResultsFolder, TellsEveryFault) {
  temporary_.write("run/summary.json", "");
  temporary_.write("run/provenance.json", "");
  temporary_.write("run/effective.yaml", "a: 1\n");
  temporary_.write("run/steps.jsonl", "");
  EXPECT_THAT(fault(), AllOf(HasSubstr("summary.json:1"), HasSubstr("provenance.json:1"),
                             HasSubstr("effective.yaml:2"), HasSubstr("steps.jsonl:1")));
}

TEST_F(ResultsFolder, IsFoundInAFolderOfVariants) {
  write_results("another");
  write_results(".hidden");
  fs::create_directory(temporary_.path() / "notes");
  EXPECT_TRUE(is_results_folder(folder()));
  EXPECT_FALSE(is_results_folder(temporary_.path()));
  EXPECT_THAT(results_folders(folder()), ElementsAre(folder()));
  EXPECT_THAT(results_folders(temporary_.path()), ElementsAre(temporary_.path() / "another", folder()));
  // One that has lost its provenance is not passed over in silence.
  fs::remove(folder() / "provenance.json");
  EXPECT_THAT(results_folders(temporary_.path()), ElementsAre(temporary_.path() / "another", folder()));
  EXPECT_THROW(static_cast<void>(results_folders(temporary_.path() / "notes")), ConfigError);
  EXPECT_THROW(static_cast<void>(results_folders(temporary_.path() / "missing")), ConfigError);
}

TEST_F(ResultsFolder, JsonThatIsTooDeepToCopyIsRefused) {
  std::string deep(200000, '[');
  deep += std::string(200000, ']');
  temporary_.write("run/provenance.json",
                   R"({"host": "[[", "cpu": ")" + std::string(100, '[') + R"(\"", "more": )" + deep + "}");
  EXPECT_THAT(fault(),
              HasSubstr("provenance.json: error: is not as glocal run leaves it (nested deeper than 64"));
  temporary_.write("run/provenance.json", R"({"host": ")" + std::string(100, '[') +
                                              R"(\"", "cpu": "", "threads": 1, "inputs_sha256": {}})");
  EXPECT_EQ(fault(), "");
}

TEST_F(ResultsFolder, WhatCannotBeLookedIntoIsNoneOrSaysWhy) {
  fs::create_symlink("loop", temporary_.path() / "loop");
  EXPECT_THAT(results_folders(temporary_.path()), ElementsAre(folder()));
  fs::create_symlink("summary.json", folder() / "more");
  fs::remove(folder() / "summary.json");
  fs::create_symlink("summary.json", folder() / "summary.json");
  EXPECT_THAT(fault(), HasSubstr("summary.json: error: cannot be read"));
  EXPECT_THAT(results_folders(temporary_.path()), ElementsAre(folder()));
}

TEST_F(ResultsFolder, NumbersOfTrialsAndStepsAreWholeOnes) {
  for (const char* odd : {"-1", "1e300", "0.5", "\"0\"", "null"}) {
    temporary_.write("run/steps.jsonl", fmt::format(R"({{"trial":{},"step":0}})", odd));
    EXPECT_THAT(fault(), HasSubstr("is no line of results ('trial' is no whole number from 0 on)")) << odd;
  }
}

}  // namespace
}  // namespace glocal::test::results_folder_test
