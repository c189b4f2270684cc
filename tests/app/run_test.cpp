// glocal run.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/room.hpp"
#include "evaluation/results/pcd.hpp"
#include "glocal/points.hpp"

namespace glocal::test::run_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using RunCommand = Room;

TEST_F(RunCommand, LeavesTheFilesOfTheContract) {
  const Answer answer = good(run_room("a", ""));
  EXPECT_THAT(answer.out, HasSubstr("room, seed 1\n"));
  EXPECT_THAT(answer.out, HasSubstr(file("a")));
  for (const char* name :
       {"summary.json", "trials.jsonl", "steps.jsonl", "effective.yaml", "provenance.json", "maps/global.pcd",
        "maps/global_grid.json", "maps/trial_0000/step_0000.pcd", "maps/trial_0000/scan_0000.pcd",
        "trajectories/trial_0000_estimate.tum", "trajectories/trial_0000_localized.tum",
        "trajectories/trial_0000_reference.tum"}) {
    EXPECT_TRUE(fs::exists(file("a") + "/" + name)) << name;
  }
  const Json origin = json("a/provenance.json");
  EXPECT_EQ(origin["command"], fmt::format("glocal run {} --out {}", file("room.yaml"), file("a")));
  EXPECT_THAT(origin["began"].get<std::string>(), testing::MatchesRegex("20..-..-..T..:..:..Z"));
  const Json summary = json("a/summary.json");
  EXPECT_EQ(summary["complete"], true);
  const std::string trials = content(file("a/trials.jsonl"));
  EXPECT_EQ(summary["trials"]["count"], std::count(trials.begin(), trials.end(), '\n'));
  EXPECT_GT(summary["trials"]["count"], 1);
}

/// Distance to the nearest of the room's walls, m.
double distance_to_walls(const Point& p) {
  const std::vector<std::array<double, 4>> walls = {{0, 0, 12, 0}, {12, 0, 12, 4}, {12, 4, 7, 6},
                                                    {7, 6, 0, 6},  {0, 6, 0, 0},   {5, 0, 5, 2.4}};
  double nearest = 1e9;
  for (const auto& [x1, y1, x2, y2] : walls) {
    const double dx = x2 - x1, dy = y2 - y1;
    const double along = std::clamp(((p.x - x1) * dx + (p.y - y1) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(p.x - x1 - along * dx, p.y - y1 - along * dy));
  }
  return nearest;
}

TEST_F(RunCommand, LeavesTheScanOfEachStepInTheRobotsFrame) {
  good(run_room("a", "--quiet --set output.maps=all"));
  for (const Json& step : json_lines("a/steps.jsonl")) {
    const Json& pose = step["reference"];
    const Transform map_from_robot(Pose2{pose["x"], pose["y"], pose["theta"]});
    const Points hits = read_pcd(
        fmt::format("a/maps/trial_{:04}/scan_{:04}.pcd", step["trial"].get<int>(), step["step"].get<int>()));
    EXPECT_GT(hits.size(), 50U);
    for (std::size_t i = 0; i < hits.size(); ++i)
      ASSERT_LT(distance_to_walls(map_from_robot(hits[i])), 0.15)
          << step["trial"] << ", step " << step["step"];
  }
}

TEST_F(RunCommand, TellsOfAnExperimentThatCanNeverDeclare) {
  // The default rule wants three steps in a row.
  const std::string one_step = "--set trials.max_steps=1";
  const std::string why =
      "no trial can end with a declared pose: the verdict rule 'consecutive_rating' declares none before "
      "step 3, and no trial has more than 1.";
  EXPECT_THAT(run_room("a", one_step).err, HasSubstr(why));
  EXPECT_THAT(run("check room.yaml " + one_step).err, HasSubstr(why));
  EXPECT_THAT(run("check room.yaml").err, Not(HasSubstr("no trial can end")));
  const std::string sooner = " --set localizer.verdict_rule.consecutive_rating.consecutive=1";
  EXPECT_THAT(run("check room.yaml " + one_step + sooner).err, Not(HasSubstr("no trial can end")));
}

TEST_F(RunCommand, SaysWhichMethodAnExperimentWithoutOneIsRunWith) {
  folder_.write("bare.yaml",
                "schema: 1\nname: bare\nmap: {simulation: {world: world.yaml}}\n"
                "observations: {simulation: {world: world.yaml}}\ntrials: {starts_m: [0], max_steps: 1}\n");
  const std::string said = "bare.yaml names no localizer: it is run with the paper's method";
  EXPECT_THAT(run("run bare.yaml --out bare").err, HasSubstr(said));
  for (const std::string options :
       {"a --quiet", "b --method indexed", "c --set localizer.matcher=indexed_ransam"}) {
    const Answer answer = good(run("run bare.yaml --out " + file("") + options));
    EXPECT_THAT(answer.err, testing::Not(HasSubstr(said))) << options;
  }
}

TEST_F(RunCommand, OnlyValuesChangeResults) {
  const std::string values = "--quiet --set localizer.matcher.ransam.iterations=15000 --seed ";
  good(run_room("one", values + "3 --threads 1"));
  good(run_room("two", values + "3 --threads 2"));
  expect_same_results("one", "two");
  EXPECT_EQ(json("one/summary.json")["seed"], 3);
  EXPECT_EQ(json("two/provenance.json")["threads"], 2);
  // Searches in pieces, too: an undecided robot is led into the exact search, and what it declares is
  // verified.
  const std::string in_pieces =
      "--quiet --set localizer.verifier=whole_map --set localizer.matcher=indexed_ransam --set "
      "localizer.matcher.indexed_ransam.exact_search.after_steps=1 --set localizer.looks_per_step=";
  for (const std::string looks : {"1", "10", "1000000000", "0"}) {
    good(run_room("piece" + looks, in_pieces + looks + " --threads 1"));
    good(run_room("threads" + looks, in_pieces + looks + " --threads 3"));
    expect_same_results("piece" + looks, "threads" + looks);
  }
  // A run waits for what a step leaves open, so that pieces change nothing but times.
  for (const char* pieces : {"piece1", "piece10", "piece1000000000"}) expect_same_results("piece0", pieces);
  bool has_gone_on = false;
  for (const Json& step : json_lines("piece1/steps.jsonl")) {
    EXPECT_FALSE(step.value("/verification/goes_on"_json_pointer, false)) << step;
    has_gone_on = has_gone_on || step["stage_ms"].contains("after");
  }
  EXPECT_TRUE(has_gone_on);
  for (const Json& step : json_lines("piece0/steps.jsonl"))
    EXPECT_FALSE(step["stage_ms"].contains("after")) << step;
  good(run("run one/effective.yaml --quiet --out again"));
  expect_same_results("one", "again");
  EXPECT_EQ(content("one/effective.yaml"), content("again/effective.yaml"));
  good(run_room("other", values + "2"));
  EXPECT_NE(lines("one/steps.jsonl"), lines("other/steps.jsonl"));
}

TEST_F(RunCommand, ABadConfigurationLeavesNoFolder) {
  for (const char* set :
       {"localizer.matcher.ransam.iterations=0", "trials.every_scan=0", "trials.min_steps=100000"}) {
    const Answer answer = run_room("a", std::string("--set ") + set);
    EXPECT_EQ(answer.exit_code, 2) << set;
    EXPECT_THAT(answer.err, HasSubstr("error")) << set;
    EXPECT_FALSE(fs::exists("a")) << set;
  }
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().string().find("unfinished"), std::string::npos) << entry.path();
  }
}

TEST_F(RunCommand, SaysWhatIsWrongWithTheFolderBeforeAnythingIsComputed) {
  const Answer quiet = good(run_room("a"));
  EXPECT_EQ(quiet.out + quiet.err, "");
  fs::create_directory_symlink("there", "here");
  fs::create_directory_symlink("here", "there");
  // What the drive is too short for shows only when it is there.
  const std::string too_long = "--quiet --set trials.min_steps=100000";
  EXPECT_THAT(refusal(run_room("a", too_long)), HasSubstr("the folder exists and is not empty"));
  EXPECT_THAT(run_room("here", too_long).err, HasSubstr("leads in a circle"));
  EXPECT_THAT(run_room("world.yaml/a", too_long).err, HasSubstr("cannot write: Not a directory"));
  EXPECT_THAT(refusal(run_room("world.yaml/results"), 1), HasSubstr("cannot write: Not a directory"));
  good(run_room("a", "--quiet --force --seed 9"));
  EXPECT_EQ(json("a/summary.json")["seed"], 9);
}

TEST_F(RunCommand, WritesWhatALinkLeadsTo) {
  fs::create_directory_symlink("missing", "link");
  for (const std::string seed : {"1", "2"}) {
    good(run_room("link", "--quiet --force --seed " + seed));
    EXPECT_TRUE(fs::is_symlink("link"));
    EXPECT_EQ(json("missing/summary.json")["seed"], std::stoi(seed));
  }
  write_experiment("trials: {every_scan: 6, max_steps: 2}\n",
                   "variants: {list: {a: {seed: 3}, b: {seed: 4}}}\n");
  fs::create_directory_symlink("others", "variants");
  good(run_room("variants"));
  EXPECT_EQ(json("others/b/summary.json")["seed"], 4);
}

TEST_F(RunCommand, AFullDiskLeavesNothing) {
  const std::string limited =
      "-c 'ulimit -f 4; exec " GLOCAL_PROGRAM " run room.yaml --quiet --out " + file("a") + "' 2>why";
  const int status = std::system(("bash " + limited).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(content("why"),
              AllOf(HasSubstr(file("a") + ": cannot write "), HasSubstr(": File too large (for the limit")));
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_TRUE(entry.is_regular_file()) << entry.path();
  }
}

TEST_F(RunCommand, AnInterruptKeepsFinishedTrials) {
  // Enough trials for half a minute; interrupted as soon as the first has been written.
  write_experiment("trials: {every_scan: 1, max_steps: 10}\n");
  const std::string start = GLOCAL_PROGRAM
      " run room.yaml --set localizer.matcher.ransam.iterations=300000 --out a >out 2>err & pid=$!; ";
  const std::string interrupt =
      "for i in $(seq 600); do grep -qs \" trial \" .a.unfinished/journal/* && break; sleep 0.1; done; kill "
      "-INT $pid; wait $pid";
  const int status = std::system(("bash -c '" + start + interrupt + "'").c_str());
  ASSERT_EQ(WEXITSTATUS(status), 3) << content("err");
  EXPECT_THAT(content("err"), HasSubstr("trials were finished and kept"));
  const Json summary = json("a/summary.json");
  EXPECT_EQ(summary["complete"], false);
  const std::string trials = content("a/trials.jsonl");
  EXPECT_EQ(summary["trials"]["count"], std::count(trials.begin(), trials.end(), '\n'));
  EXPECT_GE(summary["trials"]["count"], 1);
}

// Nothing the robot sees can tell.
TEST_F(RunCommand, APerfectlySymmetricWorldIsNeverDeclared) {
  write_symmetric_world();
  std::ofstream("room.yaml") << "schema: 1\n"
                                "name: room\n"
                                "map: {simulation: {world: world.yaml}}\n"
                                "observations: {simulation: {world: world.yaml}}\n"
                                "trials: {whole: true}\n"
                                "localizer: {matcher: indexed_ransam, threshold_policy: fixed, "
                                "verdict_rule: staged_margin}\n";
  good(run_room("symmetric"));
  const std::vector<Json> steps = json_lines("symmetric/steps.jsonl");
  for (const Json& step : steps) {
    EXPECT_EQ(step["verdict"], "ambiguous") << step["step"];
    EXPECT_THAT(step["why"].get<std::string>(), HasSubstr("2 poses")) << step["step"];
  }
  EXPECT_GT(steps.size(), 15U);
}

}  // namespace
}  // namespace glocal::test::run_test
