// glocal simulate.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace glocal::test::simulate_test {
namespace {

using testing::HasSubstr;

class SimulateCommand : public CommandLine {
 protected:
  SimulateCommand() {
    write_world();
    std::ofstream(file("experiment.yaml")) << "schema: 1\n"
                                              "name: room\n"
                                              "map: {simulation: {world: world.yaml}}\n"
                                              "observations: {simulation: {world: world.yaml}}\n"
                                              "trials: {whole: true}\n"
                                              "localizer: {matcher: {ransam: {iterations: 20000}}}\n";
  }
};

TEST_F(SimulateCommand, WhatItWritesRunsLikeTheSimulation) {
  Answer answer = good(run("simulate experiment.yaml --seed 5 --out recorded"));
  answer = good(run("run experiment.yaml --seed 5 --quiet --out a"));
  answer = good(run("run recorded/experiment.yaml --quiet --out b"));
  const auto a = nlohmann::json::parse(content("a/summary.json"));
  const auto b = nlohmann::json::parse(content("b/summary.json"));
  EXPECT_EQ(a["seed"], b["seed"]);
  EXPECT_EQ(a["trials"], b["trials"]);
  EXPECT_EQ(a["map"]["points"], b["map"]["points"]);
  const auto first_line = [&](const std::string& trajectory) {
    const std::string text = content(trajectory);
    return text.substr(0, text.find('\n'));
  };
  EXPECT_EQ(first_line("a/trajectories/trial_0000_reference.tum"),
            first_line("b/trajectories/trial_0000_reference.tum"));
}

TEST_F(SimulateCommand, WritesADriveInAMap) {
  Answer answer = good(run("simulate experiment.yaml --out mapped"));
  std::ofstream("tour.yaml") << "schema: 1\n"
                                "name: tour\n"
                                "map: {ros_map: {path: mapped/map.yaml}}\n"
                                "observations:\n"
                                "  simulation:\n"
                                "    map: mapped/map.yaml\n"
                                "    tour_legs: 5\n"
                                "    boxes: 3\n"
                                "    people: 2\n"
                                "    kidnappings: [{after_m: 5, to: [1, 1]}]\n"
                                "trials: {whole: true}\n"
                                "localizer: {matcher: {ransam: {iterations: 5000}}}\n";
  answer = good(run("simulate tour.yaml --seed 5 --out recorded"));
  answer = good(run("run tour.yaml --seed 5 --quiet --out a"));
  answer = good(run("run recorded/experiment.yaml --quiet --out b"));
  EXPECT_EQ(content("recorded/map.pgm"), content("mapped/map.pgm"));
  const auto poses = [&](const std::string& results) {
    const std::string text = content(results + "/trajectories/trial_0000_reference.tum");
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_GT(poses("a"), 30);
  EXPECT_EQ(poses("a"), poses("b"));
  EXPECT_THAT(content("a/provenance.json"), HasSubstr("mapped/map.pgm")) << "what was read";
}

TEST_F(SimulateCommand, TheSameSeedGivesTheSameBytes) {
  good(run("simulate experiment.yaml --seed 5 --out a"));
  good(run("simulate experiment.yaml --seed 5 --out b"));
  good(run("simulate experiment.yaml --seed 6 --out c"));
  for (const std::string name : {"/drive.log", "/map.yaml", "/map.pgm", "/experiment.yaml"}) {
    EXPECT_EQ(content("a" + name), content("b" + name));
  }
  EXPECT_NE(content("a/drive.log"), content("c/drive.log"));
}

TEST_F(SimulateCommand, RefusesARecordedDriveAndAFullFolder) {
  good(run("simulate experiment.yaml --out a"));
  EXPECT_THAT(
      refusal(run("simulate a/experiment.yaml --out b")),
      HasSubstr(
          "observations: come from carmen_log; only a simulation of a planar laser can be written to files"));
  EXPECT_THAT(refusal(run("simulate experiment.yaml --out a")),
              HasSubstr("the folder exists and is not empty"));
  good(run("simulate experiment.yaml --force --out a"));
  const Answer both = run("simulate a/experiment.yaml --out a");
  EXPECT_THAT(both.err, HasSubstr("the folder exists and is not empty")) << "before the drive is looked at";
}

TEST_F(SimulateCommand, WritesWhatALinkLeadsTo) {
  std::filesystem::create_directory_symlink("missing", "link");
  good(run("simulate experiment.yaml --out link"));
  EXPECT_NE(content("missing/drive.log"), "");
}

TEST_F(SimulateCommand, ASiteCanBeRunAndLocalizedIn) {
  const std::string simulate = "simulate --site office --side 30 --length 60 --starts 6 --seed 3";
  Answer answer = good(run(simulate + " --out site"));
  EXPECT_THAT(answer.out, HasSubstr("a map of 601 x 601 cells"));
  answer = good(run("run site/experiment.yaml --quiet --out results"));
  const auto summary = nlohmann::json::parse(content("results/summary.json"));
  EXPECT_EQ(summary["name"], "office_30_3");
  EXPECT_GE(summary["trials"]["count"], 4) << "the last starts have less than 41 scans left";
  EXPECT_GE(summary["trials"]["right"], 3);
  EXPECT_EQ(summary["trials"]["wrong"], 0);
}

TEST_F(SimulateCommand, AShortDriveInASiteCanBeRun) {
  good(run("simulate --site office --side 25 --length 10 --out site"));
  good(run("run site/experiment.yaml --quiet --out results"));
  EXPECT_EQ(nlohmann::json::parse(content("results/summary.json"))["trials"]["count"], 1);
}

TEST_F(SimulateCommand, TheSameSeedGivesTheSameSite) {
  const std::string simulate = "simulate --site office --side 25 --length 20 --resolution 0.1 ";
  good(run(simulate + "--seed 5 --out a"));
  good(run(simulate + "--seed 5 --out b"));
  good(run(simulate + "--seed 6 --out c"));
  for (const std::string name : {"/drive.log", "/map.yaml", "/map.pgm", "/experiment.yaml"}) {
    EXPECT_EQ(content("a" + name), content("b" + name)) << name;
    EXPECT_NE(content("a" + name), "") << name;
  }
  for (const std::string name : {"/drive.log", "/map.pgm", "/experiment.yaml"})
    EXPECT_NE(content("a" + name), content("c" + name)) << name;
}

TEST_F(SimulateCommand, RefusesSitesThatCannotBe) {
  const std::string out = " --out site";
  const auto fault_of = [&](const std::string& options) {
    const Answer answer = run("simulate " + options + out);
    EXPECT_EQ(answer.exit_code, 2) << options;
    EXPECT_FALSE(std::filesystem::exists("site")) << options;
    return answer.err;
  };
  EXPECT_THAT(fault_of(""), HasSubstr("takes an experiment file, or --site office in its place"));
  EXPECT_THAT(fault_of("experiment.yaml --site office --side 50"),
              HasSubstr("takes an experiment file, or --site office in its place"));
  EXPECT_THAT(fault_of("--site office"), HasSubstr("needs --side"));
  EXPECT_THAT(fault_of("--site castle --side 50"), HasSubstr("castle not in {office}"));
  EXPECT_THAT(fault_of("--side 50 experiment.yaml"), HasSubstr("--side requires --site"));
  EXPECT_THAT(fault_of("--site office --side 50 --seed x"),
              HasSubstr("--seed x: error: must be a whole number from 0 to 2^64 - 1"));
  EXPECT_THAT(fault_of("--site office --side 50 --set seed=3"), HasSubstr("--set excludes --site"));
  for (const char* options : {"--side 19", "--side 2001", "--side nan", "--side 50 --resolution 0.001",
                              "--side 50 --length 5", "--side 50 --length 1e6"}) {
    EXPECT_THAT(fault_of(std::string("--site office ") + options), HasSubstr("is not a number from"));
  }
  EXPECT_THAT(fault_of("--site office --side 2000"),
              HasSubstr("--site office: error: its map would have more than 1000 million cells of 0.05 m; "
                        "raise resolution to 0.07 or more"));
  EXPECT_THAT(fault_of("--site office --side 50 --starts 0"), HasSubstr("not in range"));
}

}  // namespace
}  // namespace glocal::test::simulate_test
