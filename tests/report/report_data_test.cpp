#include "report/report_data.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/results/pcd.hpp"
#include "evaluation/results/records.hpp"
#include "evaluation/results/writers.hpp"
#include "files.hpp"
#include "points.hpp"
#include "report/unpacked.hpp"

namespace glocal::test::report_data_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Folders as glocal run leaves them: trial 0 of three steps with local maps and scans, trial 1 of one step.
class ReportDataTest : public testing::Test {
 protected:
  ReportDataTest() { write_run("a"); }

  void write_run(const std::string& name, double first_start_m = 0.0) const {
    write_summary(name, true, 2, 4);
    folder_.write(name + "/provenance.json",
                  R"({"host": "h", "cpu": "c", "threads": 2, "inputs_sha256": {"/lab.log": "abc"}})");
    folder_.write(
        name + "/effective.yaml",
        "seed: 7\nmap:\n  carmen_log:\n    path: \"/lab.log\"\noutput:\n  steps: true\n  maps: all\n");
    folder_.write(name + "/trials.jsonl", trial(0, 3, first_start_m) + trial(1, 1, first_start_m + 5.0));
    folder_.write(name + "/steps.jsonl", step(0, 0) + step(0, 1) + step(0, 2) + step(1, 0));
    folder_.write(name + "/maps/global.pcd", pcd(points_at({{0, 0}, {0.05F, 0}, {0.1F, 0}})));
    for (int i = 0; i < 3; ++i) {
      const auto x = static_cast<float>(i);
      folder_.write(fmt::format("{}/maps/trial_0000/step_000{}.pcd", name, i),
                    pcd(points_at({{9, 9}, {x, 1}})));
      folder_.write(fmt::format("{}/maps/trial_0000/scan_000{}.pcd", name, i), pcd(points_at({{x, -1}})));
    }
  }

  void write_summary(const std::string& name, bool complete, int trials, int steps) const {
    folder_.write(
        name + "/summary.json",
        fmt::format(
            R"({{"name": "lab", "seed": 7, "complete": {}, "trials": {{"count": {}, "right": 1, "wrong": 0, "undecided": 0}}, "steps": {}}})",
            complete, trials, steps));
  }

  static std::string trial(std::size_t number, std::size_t steps, double start_m) {
    TrialRecord record;
    record.trial = number;
    record.start_m = start_m;
    record.steps = steps;
    record.why = "a </script> & b";
    return trial_line(record);
  }

  static std::string step(std::size_t trial, std::size_t number) {
    return step_line(trial, step_record(number, {1.0, 2.0, 0.5}));
  }

  [[nodiscard]] Json data(const std::vector<std::string>& names, const ReportLimits& limits = {},
                          std::size_t baseline = 0) const {
    ReportData data(limits);
    std::vector<NamedRun> runs;
    for (const std::string& name : names) {
      data.add(folder_ / name);
      runs.push_back({name, read_results(folder_ / name)});
    }
    return whole(data.page_data(runs, baseline));
  }

  /// All that is said of a folder.
  [[nodiscard]] std::vector<std::string> faults(const std::string& name = "a") const {
    return config_faults(folder_.path(), [&] { ReportData({}).add(folder_ / name); });
  }

  TemporaryFolder folder_;
};

TEST_F(ReportDataTest, IsAllThatTheRunLeft) {
  const Json json = data({"a"});
  EXPECT_EQ(json["format"], 1);
  EXPECT_THAT(json["generator"].get<std::string>(), testing::StartsWith("glocal "));
  EXPECT_EQ(json["maps"], Json::parse(R"([{"x": [0, 50, 100], "y": [0, 0, 0], "spacing_m": 0.05}])"));
  EXPECT_FALSE(json.contains("comparison"));
  EXPECT_FALSE(json.contains("comparison_refused"));
  ASSERT_EQ(json["runs"].size(), 1U);
  const Json& run = json["runs"][0];
  EXPECT_EQ(run["name"], "a");
  EXPECT_EQ(run["folder"], (folder_ / "a").string());
  EXPECT_EQ(run["summary"]["seed"], 7);
  EXPECT_EQ(run["provenance"]["inputs_sha256"]["/lab.log"], "abc");
  EXPECT_EQ(run["settings"], Json::parse(R"({"map.carmen_log.path": {"text": "/lab.log", "identity": "abc"},
                                             "output.maps": {"text": "all"},
                                             "output.steps": {"text": "true"}, "seed": {"text": "7"}})"));
  EXPECT_EQ(run["map"], 0);
  EXPECT_EQ(run["step_ms"], Json::parse("[10, 10, 10, 10]"));  // four stages of 1 to 4 ms
  ASSERT_EQ(run["trials"].size(), 2U);
  const Json& first = run["trials"][0];
  EXPECT_EQ(first["steps"], 3);
  EXPECT_EQ(first["why"], "a </script> & b");
  EXPECT_EQ(first["columns"]["step"], Json::parse("[0, 1, 2]"));
  EXPECT_EQ(first["local_map"], Json::parse(R"({"steps": [0, 1, 2], "x": [0, 1000, 2000, 9000],
      "y": [1000, 1000, 1000, 9000], "from": [0, 1, 2, 0], "to": [1, 2, 3, 3]})"));
  EXPECT_EQ(first["scans"], Json::parse(R"({"steps": [0, 1, 2], "first": [0, 1, 2, 3], "x": [0, 1000, 2000],
      "y": [-1000, -1000, -1000]})"));
  const Json& second = run["trials"][1];
  EXPECT_EQ(second["trial"], 1);
  EXPECT_EQ(second["columns"]["step"], Json::parse("[0]"));
  EXPECT_FALSE(second.contains("local_map"));
  EXPECT_FALSE(second.contains("scans"));
}

TEST_F(ReportDataTest, NamesTheFolderThatWasGivenWhereverItsFilesWereRead) {
  ReportData data({});
  NamedRun run{"shards", data.add(folder_ / "a")};
  run.results.folder = "results/shards";
  const Json told = data.page_data({run}, 0).head["runs"][0];
  EXPECT_EQ(told["name"], "shards");
  EXPECT_EQ(told["folder"], "results/shards");
}

TEST_F(ReportDataTest, HasNoMoreDigitsOfTrialsThanAreRead) {
  folder_.write("a/trials.jsonl", trial(0, 3, 1.0 / 3.0) + trial(1, 1, 5.0));
  const Json start = data({"a"})["runs"][0]["trials"][0]["start"];
  EXPECT_EQ(start["distance_m"].dump(), "0.3333333");
}

TEST_F(ReportDataTest, HasTimesOfStepsInTheirOrderButNoMoreThanAreDrawn) {
  std::string steps;
  for (std::size_t i = 0; i < 1000; ++i) {
    StepRecord record = step_record(i, {1.0, 2.0, 0.5});
    record.result.stage_ms = {.local_map = static_cast<double>((7 * i) % 1000)};
    steps += step_line(0, record);
  }
  folder_.write("a/trials.jsonl", trial(0, 1000, 0.0));
  folder_.write("a/steps.jsonl", steps);
  write_summary("a", true, 1, 1000);
  fs::remove_all(folder_ / "a/maps");
  const Json run = data({"a"})["runs"][0];
  EXPECT_EQ(run["timed_steps"], 1000);
  const Json& times = run["step_ms"];
  ASSERT_EQ(times.size(), 200U);
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 999);
  for (std::size_t i = 1; i < times.size(); ++i)
    EXPECT_NEAR(times[i].get<double>() - times[i - 1].get<double>(), 5.0, 1.0);
}

TEST_F(ReportDataTest, DoesWithoutWhatWasNotRecorded) {
  folder_.write("a/effective.yaml", "output: {steps: false, maps: all}\n");
  fs::remove(folder_ / "a/steps.jsonl");
  for (int i = 0; i < 3; ++i) fs::remove(folder_ / fmt::format("a/maps/trial_0000/scan_000{}.pcd", i));
  Json trial = data({"a"})["runs"][0]["trials"][0];
  EXPECT_FALSE(trial.contains("columns"));
  EXPECT_FALSE(trial.contains("scans"));
  EXPECT_EQ(trial["local_map"]["steps"], Json::parse("[0, 1, 2]"));
  fs::remove_all(folder_ / "a/maps");
  const Json run = data({"a"})["runs"][0];
  EXPECT_FALSE(run.contains("map"));
  EXPECT_FALSE(run["trials"][0].contains("local_map"));
}

TEST_F(ReportDataTest, TakesARunThatWasInterrupted) {
  write_summary("a", false, 1, 1);
  folder_.write("a/trials.jsonl", trial(1, 1, 5.0));
  folder_.write("a/steps.jsonl", step(1, 0));
  const Json trials = data({"a"})["runs"][0]["trials"];
  ASSERT_EQ(trials.size(), 1U);
  EXPECT_EQ(trials[0]["trial"], 1);
}

TEST_F(ReportDataTest, TakesATrialThatFailedInItsFirstStep) {
  folder_.write("a/trials.jsonl", trial(0, 3, 0.0) + trial(1, 0, 5.0));
  folder_.write("a/steps.jsonl", step(0, 0) + step(0, 1) + step(0, 2));
  write_summary("a", true, 2, 3);
  EXPECT_EQ(data({"a"})["runs"][0]["trials"][1]["columns"]["step"], Json::array());
}

TEST_F(ReportDataTest, HasEachMapOnce) {
  write_run("b");
  write_run("c");
  folder_.write("c/maps/global.pcd", pcd(points_at({{0, 0}, {0.06F, 0}})));
  const Json json = data({"a", "b", "c"});
  ASSERT_EQ(json["maps"].size(), 2U);
  EXPECT_EQ(json["runs"][1]["map"], 0);
  EXPECT_EQ(json["runs"][2]["map"], 1);
}

TEST_F(ReportDataTest, HasTheCellsOfAMapThatHasSome) {
  const Json grid = Json::parse(R"({"resolution": 0.05, "origin": {"x": 0, "y": 0, "theta": 0},
    "width": 2, "height": 1, "cells": "1f1o"})");
  write_run("b");
  folder_.write("b/maps/global_grid.json", grid.dump());
  const Json json = data({"a", "b"});
  ASSERT_EQ(json["maps"].size(), 2U);
  EXPECT_FALSE(json["maps"][0].contains("grid"));
  EXPECT_EQ(json["maps"][1]["grid"], grid);
  folder_.write("a/maps/global_grid.json", "{}");
  EXPECT_THAT(faults(), ElementsAre(HasSubstr("a/maps/global_grid.json: error: is no grid")));
}

TEST_F(ReportDataTest, HasWhatATrialHasFoundChanged) {
  const Json changes =
      Json::parse(R"({"new": [{"x": 1.5, "y": 2.5, "width": 0.4, "height": 0.2, "views": 4}], "gone": []})");
  folder_.write("a/maps/trial_0000/changes.json", changes.dump());
  EXPECT_EQ(data({"a"})["runs"][0]["trials"][0]["changes"], changes);
  for (const char* broken : {"{}", "[]", R"({"new": [{"x": 1}], "gone": []})", R"({"new": 1, "gone": []})"}) {
    folder_.write("a/maps/trial_0000/changes.json", broken);
    EXPECT_THAT(faults(), ElementsAre(HasSubstr("changes.json: error: has no changes"))) << broken;
  }
}

TEST_F(ReportDataTest, ComparesRunsOrSaysWhyNot) {
  write_run("b");
  write_run("elsewhere", 2.5);
  const Json json = data({"a", "b"});
  EXPECT_EQ(json["comparison"]["baseline"], "a");
  EXPECT_EQ(json["comparison"]["starts"], 2);
  EXPECT_FALSE(json.contains("comparison_refused"));
  const Json refused = data({"a", "elsewhere"});
  EXPECT_FALSE(refused.contains("comparison"));
  EXPECT_THAT(refused["comparison_refused"].get<std::string>(), HasSubstr("none of its 2 starts"));
}

TEST_F(ReportDataTest, HasWhatASweepHasTaught) {
  write_run("b");
  EXPECT_FALSE(data({"a", "b"}).contains("sweep"));
  const auto tell = [&](const char* folder, const char* size) {
    Json provenance = {{"host", "h"}, {"cpu", "c"}, {"threads", 2}, {"inputs_sha256", Json::object()}};
    provenance["variant"] = {
        {"setting", folder}, {"seed", 7}, {"case", ""}, {"role", "none"}, {"values", {{"x.size", size}}}};
    folder_.write(std::string(folder) + "/provenance.json", provenance.dump());
  };
  tell("a", "1");
  tell("b", "2");
  const Json sweep = data({"a", "b"})["sweep"];
  EXPECT_EQ(sweep["settings"].size(), 2U);
  EXPECT_EQ(sweep["effects"][0]["path"], "x.size");
  EXPECT_EQ(sweep["chance"]["baseline"], "a");
  const Json against_b = data({"a", "b"}, {}, 1);
  EXPECT_EQ(against_b["sweep"]["chance"]["baseline"], "b");
  EXPECT_EQ(against_b["comparison"]["baseline"], "b");
  // Two runs of the same part are none of one sweep, but can be shown.
  fs::copy(folder_ / "a/provenance.json", folder_ / "b/provenance.json",
           fs::copy_options::overwrite_existing);
  EXPECT_FALSE(data({"a", "b"}).contains("sweep"));
}

TEST_F(ReportDataTest, SharesItsLimitsAmongAllTrialsWithMaps) {
  write_run("b");
  // 4 lives and 3 points of scans each.
  EXPECT_EQ(data({"a", "b"}, {.lives = 8, .scan_points = 6})["runs"][0]["trials"][0]["scans"]["steps"].size(),
            3U);
  const Json json = data({"a", "b"}, {.clusters = 1, .lives = 7, .scan_points = 5});
  for (const Json& run : json["runs"]) {
    EXPECT_EQ(run["trials"][0]["local_map"]["steps"], Json::parse("[0, 2]"));
    EXPECT_EQ(run["trials"][0]["scans"]["steps"], Json::parse("[0, 2]"));
    EXPECT_EQ(run["trials"][0]["columns"]["best"]["first"], Json::parse("[0, 1, 2, 3]"));
  }
}

TEST_F(ReportDataTest, FindsEveryFaultOfAFolder) {
  folder_.write("a/summary.json", "{");
  folder_.write("a/provenance.json", "[]");
  folder_.write("a/effective.yaml", "a: [\n");
  folder_.write("a/steps.jsonl", step(0, 0) + step(0, 2));
  folder_.write("a/maps/global.pcd", "points");
  fs::remove(folder_ / "a/maps/trial_0000/scan_0001.pcd");
  EXPECT_THAT(
      faults(),
      ElementsAre(HasSubstr("a/effective.yaml:"), HasSubstr("a/maps/global.pcd: error: is no PCD file"),
                  HasSubstr("a/maps/trial_0000/scan_0001.pcd: error: cannot be read"),
                  HasSubstr("a/provenance.json: error: is not as glocal run leaves it"),
                  AllOf(HasSubstr("a/steps.jsonl:2: error:"), HasSubstr("where step 1 belongs")),
                  HasSubstr("a/summary.json:1: error: is not as glocal run leaves it")));
}

TEST_F(ReportDataTest, FindsWhatWasCutOff) {
  folder_.write("a/steps.jsonl", step(0, 0) + step(0, 1) + step(1, 0));
  EXPECT_THAT(
      faults(),
      ElementsAre(HasSubstr("a/steps.jsonl:3: error: ends here with 2 of the 3 steps of trial 0; run")));
  folder_.write("a/steps.jsonl", step(0, 0) + step(0, 1).substr(0, 200));
  EXPECT_THAT(faults(), testing::Contains(HasSubstr("a/steps.jsonl:2: error: is no line of results")));
  write_run("a");
  folder_.write("a/trials.jsonl", trial(0, 3, 0.0));
  EXPECT_THAT(faults(),
              ElementsAre(HasSubstr(
                  "a/trials.jsonl:1: error: ends here with 1 trials, where summary.json counts 2")));
  write_run("a");
  fs::remove(folder_ / "a/steps.jsonl");
  EXPECT_THAT(faults(), testing::Contains(HasSubstr("a/steps.jsonl: error: cannot be read")));
  write_run("a");
  fs::resize_file(folder_ / "a/maps/trial_0000/step_0001.pcd", 200);
  EXPECT_THAT(faults(), ElementsAre(HasSubstr("a/maps/trial_0000/step_0001.pcd: error: has")));
}

TEST_F(ReportDataTest, RefusesATrialThatIsThereTwice) {
  folder_.write("a/trials.jsonl", trial(0, 3, 0.0) + trial(0, 1, 5.0));
  EXPECT_THAT(faults(),
              testing::Contains(AllOf(HasSubstr("a/trials.jsonl:2"), HasSubstr("trial 0 is there already"))));
}

TEST_F(ReportDataTest, RefusesAFolderOfSomethingElse) {
  fs::create_directory(folder_ / "empty");
  const std::vector<std::string> said = faults("empty");
  EXPECT_EQ(said.size(), 4U);
  for (const std::string& fault : said)
    EXPECT_THAT(fault, HasSubstr("name a folder that glocal run has left"));
}

}  // namespace
}  // namespace glocal::test::report_data_test
