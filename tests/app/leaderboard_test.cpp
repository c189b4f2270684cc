// glocal leaderboard, from a suite's file to tables, checks and what others bring.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <functional>
#include <regex>

#include "app/room.hpp"
#include "report/unpacked.hpp"

namespace glocal::test::leaderboard_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A folder with configs/ of its own: a suite of one case with two seeds, and a method.
class Leaderboard : public Room {
 protected:
  Leaderboard() {
    ::setenv("GLOCAL_CONFIGS", file("configs").c_str(), 1);
    write_method(20000);
    folder_.write("configs/cases/small_room.yaml",
                  "map: {simulation: {world: ../../world.yaml}}\n"
                  "observations: {simulation: {world: ../../world.yaml}}\n"
                  "trials: {every_scan: 1, max_steps: 5}\n");
    folder_.write("configs/suites/tiny.yaml", suite_);
  }
  ~Leaderboard() override { ::unsetenv("GLOCAL_CONFIGS"); }

  void write_method(int iterations) const {
    folder_.write("configs/methods/few.yaml",
                  "# Few draws.\nlocalizer: {contact_epsilon: 0.05, matcher: {ransam: {iterations: " +
                      std::to_string(iterations) +
                      "}}, verdict_rule: {consecutive_rating: {consecutive: 1}}}\n");
  }

  void pin() const {
    const Answer answer = good(run("leaderboard pin tiny"));
    folder_.write("configs/suites/tiny.yaml", suite_ + answer.out);
  }

  void run_and_add(const std::string& options = "") const {
    good(run("run --quiet --suite tiny@1 --method few --force --out " + file("results")));
    good(run("leaderboard add " + file("results") + options));
  }

  [[nodiscard]] Json entry() const { return json("leaderboard/tiny@1/few.json"); }

  /// Calls `row` with each first step of a trial of the results.
  void for_each_first_step(const std::function<void(std::uint64_t seed, const Json& step)>& row) const {
    for (const std::uint64_t seed : {1U, 2U}) {
      for (const Json& step :
           json_lines(file(fmt::format("results/few_small_room_seed-{}/steps.jsonl", seed)))) {
        if (step.at("step") == 0) row(seed, step);
      }
    }
  }

  /// The poses of the references, moved along x, as declared ones.
  [[nodiscard]] std::string moved_references(double metres) const {
    std::string csv = "case,seed,start,step,x,y,yaw_deg,declared\n";
    for_each_first_step([&](std::uint64_t seed, const Json& step) {
      const Json& reference = step.at("reference");
      csv += fmt::format("small_room,{},{},0,{},{},{},1\n", seed, step.at("trial").get<int>(),
                         reference.at("x").get<double>() + metres, reference.at("y").get<double>(),
                         reference.at("theta").get<double>() * 180.0 / 3.14159265358979);
    });
    return csv;
  }

  [[nodiscard]] Answer import(const std::string& csv, const std::string& options = "") const {
    return run("leaderboard import " + folder_.write("poses.csv", csv).string() +
               " --suite tiny --method theirs" + options);
  }

  const std::string suite_ = "# A room.\nversion: 1\nseeds: 1..2\ncases: [small_room]\n";
};

TEST_F(Leaderboard, KeepsShowsAndChecksResults) {
  pin();
  run_and_add();
  const Json stored = entry();
  ASSERT_EQ(stored.at("results").size(), 2U);
  // What the run itself has counted.
  for (const Json& result : stored.at("results")) {
    const Json summary =
        json(fmt::format("results/few_small_room_seed-{}/summary.json", result.at("seed").get<int>()));
    const std::string outcome = result.at("outcome");
    EXPECT_EQ(outcome.size(), summary["trials"]["count"].get<std::size_t>());
    EXPECT_EQ(std::count(outcome.begin(), outcome.end(), 'r'), summary["trials"]["right"].get<int>());
    EXPECT_GT(std::count(outcome.begin(), outcome.end(), 'r'), 0);
  }
  EXPECT_EQ(stored["provenance"]["command"], "glocal run --suite tiny@1 --method few");
  EXPECT_THAT(stored.dump(), Not(HasSubstr(folder_.path().string())));
  EXPECT_THAT(run("leaderboard tiny@1").out, HasSubstr("\n  few "));
  EXPECT_THAT(run("leaderboard").out, HasSubstr("tiny@1"));
  EXPECT_THAT(run("leaderboard tiny --cases --markdown").out, HasSubstr("\n| small\\_room | "));
  EXPECT_THAT(run("list suites").out, HasSubstr("tiny@1  A room."));

  const Answer same = run("leaderboard check --share 0.3");
  EXPECT_EQ(same.exit_code, 0) << same.out;
  EXPECT_TRUE(
      std::regex_search(same.out, std::regex("tiny@1, few: [1-9]\\d* starts run anew, as they are stored")))
      << same.out;
}

TEST_F(Leaderboard, AnEntryNamesAllProcessorsThatTimesAreOf) {
  pin();
  run_and_add();
  const std::string one = entry()["provenance"]["cpu"];
  const char* second = "results/few_small_room_seed-2/provenance.json";
  Json other = json(second);
  other["cpu"] = "another";
  folder_.write(second, other.dump());
  good(run("leaderboard add --force results"));
  EXPECT_EQ(entry()["provenance"]["cpu"], one + ", another");
}

TEST_F(Leaderboard, TheNameOfAMethodStandsForItsValues) {
  pin();
  good(run("run --quiet --suite tiny@1 --method few --set localizer.contact_epsilon=0.06 --out results"));
  EXPECT_THAT(refusal(run("leaderboard add results")),
              HasSubstr("results: error: its localizer has other values than the method few; "));
  EXPECT_FALSE(std::filesystem::exists("leaderboard"));
  folder_.write("wider.yaml", "localizer: {contact_epsilon: 0.06, matcher: {ransam: {iterations: 2000}}}\n");
  good(run("run --quiet --suite tiny@1 --method wider.yaml --out wider"));
  EXPECT_THAT(good(run("leaderboard add wider")).out, HasSubstr("wider on tiny@1: "));
}

TEST_F(Leaderboard, AnEntryIsOfOneLocalizer) {
  pin();
  const auto run_seed = [&](const std::string& seed, const char* epsilon) {
    folder_.write("mine.yaml", fmt::format("localizer: {{contact_epsilon: {}, matcher: {{ransam: "
                                           "{{iterations: 2000}}}}}}\n",
                                           epsilon));
    good(run("run --quiet --suite tiny@1 --method mine.yaml --only mine_small_room_seed-" + seed +
             " --out results"));
  };
  run_seed("1", "0.05");
  run_seed("2", "0.06");
  EXPECT_THAT(refusal(run("leaderboard add results")),
              HasSubstr("results/mine_small_room_seed-2: error: has other values of the localizer than the "
                        "results beside it; run all with the same"));
  EXPECT_FALSE(std::filesystem::exists("leaderboard"));
}

TEST_F(Leaderboard, ACheckSaysWhichStartsEndOtherwise) {
  pin();
  run_and_add();
  write_method(2000);
  const Answer other = run("leaderboard check tiny@1 --method few --share 1");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.out, HasSubstr("  small_room, seed 1, start "));
  EXPECT_THAT(
      other.out,
      HasSubstr("renew leaderboard/tiny@1/few.json with:\n  glocal run --suite tiny@1 --method few "));
  const Answer named = run("leaderboard check tiny@1 --share 1 --board " + file("leaderboard"));
  EXPECT_THAT(named.out, HasSubstr("renew " + file("leaderboard/tiny@1/few.json") + " with:\n"));
  EXPECT_THAT(named.out, HasSubstr(" --board " + file("leaderboard") + " --force\n"));
}

TEST_F(Leaderboard, ASuiteThatIsAFileIsRenewedByIt) {
  const std::string suite = folder_.write("mine.yaml", suite_).string();
  folder_.write("mine.yaml", suite_ + good(run("leaderboard pin " + suite)).out);
  good(run("run --quiet --suite " + suite + " --method few --out results"));
  good(run("leaderboard add results --suite " + suite));
  write_method(2000);
  const Answer other = run("leaderboard check " + suite + " --share 1");
  EXPECT_THAT(other.out, HasSubstr("  glocal run --suite " + suite + " --method few "));
  EXPECT_THAT(other.out, HasSubstr("/few --suite " + suite + " --force\n"));
}

TEST_F(Leaderboard, RenewingNeedsForceAndComparesOldAndNew) {
  pin();
  run_and_add();
  EXPECT_THAT(refusal(run("leaderboard add results")),
              HasSubstr("few.json: error: is there already; --force replaces it"));
  write_method(2000);
  run_and_add(" --force");
  EXPECT_THAT(content(folder_.path() / "out"), HasSubstr("few of tiny@1, start by start:\n  wrong "));
  const std::vector<Json> lines = json_lines("leaderboard/history.jsonl");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[1]["suite"], "tiny@1");
  EXPECT_EQ(lines[1]["starts"], lines[0]["starts"]);
}

TEST_F(Leaderboard, AnEntryThatCannotBeReadIsReplaced) {
  pin();
  run_and_add();
  folder_.write("leaderboard/tiny@1/few.json", "{");
  EXPECT_THAT(refusal(run("leaderboard tiny@1")), HasSubstr("glocal leaderboard add writes it anew"));
  EXPECT_THAT(good(run("leaderboard add --force results")).out, HasSubstr("; it is replaced\n"));
  EXPECT_THAT(run("leaderboard tiny@1").out, HasSubstr("\n  few "));
}

TEST_F(Leaderboard, AllMethodsOfAFolderAreAddedOrNone) {
  pin();
  run_and_add();
  folder_.write("configs/methods/afew.yaml", content("configs/methods/few.yaml"));
  good(run("run --quiet --suite tiny@1 --method afew --method few --out both"));
  EXPECT_THAT(refusal(run("leaderboard add both")), HasSubstr("few.json: error: is there already"));
  EXPECT_FALSE(std::filesystem::exists("leaderboard/tiny@1/afew.json"));
  EXPECT_EQ(json_lines("leaderboard/history.jsonl").size(), 1U);
}

TEST_F(Leaderboard, ACheckOfNothingIsAnError) {
  pin();
  run_and_add();
  for (const std::string nothing : {"--method indxed", "--board /nowhere"})
    EXPECT_THAT(refusal(run("leaderboard check " + nothing)), HasSubstr("has no results")) << nothing;
  for (const char* filter : {"--cases", "--case small_room", "--force"})
    EXPECT_EQ(run(std::string("leaderboard ") + filter).exit_code, 2) << filter;
}

TEST_F(Leaderboard, WritesAPageOfWhatIsStored) {
  pin();
  run_and_add();
  const std::string page = file("board.html");
  const Answer written = good(run("leaderboard -o " + page));
  EXPECT_EQ(written.out, page + "\n");
  const std::string first = content(page);
  const Json suite = data_in(first).head["suites"][0];
  EXPECT_EQ(suite["suite"], "tiny@1");
  EXPECT_EQ(suite["entries"][0]["results"][1]["outcome"], entry()["results"][1]["outcome"]);
  EXPECT_EQ(suite["entries"][0]["renewals"].size(), 1U);
  EXPECT_THAT(run("leaderboard -o " + page).err, HasSubstr("board.html: error: "));
  good(run("leaderboard --force -o " + page));
  EXPECT_EQ(content(page), first);
}

TEST_F(Leaderboard, WritesNoPageOfWhatCannotBeRead) {
  pin();
  const auto refused = [&](const std::string& options = "") {
    const Answer answer = run("leaderboard -o board.html" + options);
    EXPECT_EQ(answer.exit_code, 2) << answer.out;
    EXPECT_FALSE(fs::exists("board.html"));
    return answer.err;
  };
  EXPECT_THAT(refused(), HasSubstr("leaderboard: error: has no results yet; glocal leaderboard add "));
  run_and_add();
  EXPECT_THAT(refused(" --method other"), HasSubstr("has no results by other yet"));
  EXPECT_THAT(refusal(run("leaderboard --board nowhere")), HasSubstr("nowhere: error: has no results yet"));
  EXPECT_THAT(refused(" --markdown"), HasSubstr("--markdown"));
  folder_.write("leaderboard/history.jsonl", "{}\n");
  EXPECT_THAT(refused(), HasSubstr("history.jsonl:1: error: is no line of a leaderboard's history"));
  folder_.write("leaderboard/history.jsonl", "");
  folder_.write("leaderboard/tiny@1/other.json", "{");
  EXPECT_THAT(refused(), HasSubstr("other.json: error: is no entry of a leaderboard"));
}

TEST_F(Leaderboard, AShareIsKeptAndCheckedAsOne) {
  pin();
  good(run("run --quiet --suite tiny@1 --share 0.3 --method few --out results"));
  good(run("leaderboard add results"));
  const Json entry = Json::parse(content("leaderboard/tiny@1/few.json"));
  EXPECT_EQ(entry["share"], 0.3);
  EXPECT_EQ(entry["provenance"]["command"], "glocal run --suite tiny@1 --method few --share 0.3");
  EXPECT_THAT(run("leaderboard tiny@1").out, HasSubstr("few (share 0.3)"));
  // A larger share has these starts, too; of the others nothing is stored.
  EXPECT_THAT(run("leaderboard check tiny@1 --share 0.6").out, HasSubstr("as they are stored"));
}

TEST_F(Leaderboard, AnInputThatHasChangedIsNamedWithBothHashes) {
  pin();
  const std::string pinned = content("configs/suites/tiny.yaml");
  std::smatch hash;
  ASSERT_TRUE(std::regex_search(pinned, hash, std::regex("\"../../world.yaml\": ([0-9a-f]{64})")));
  std::ofstream("world.yaml", std::ios::app) << "# wider\n";
  const std::string ran = refusal(run("run --quiet --suite tiny@1 --method few --out results"));
  EXPECT_THAT(ran, HasSubstr("../../world.yaml: error: "));
  EXPECT_THAT(ran, HasSubstr("is not the input of tiny@1: its SHA-256 is "));
  EXPECT_THAT(ran, HasSubstr("and " + hash[1].str() + " is pinned in "));
  EXPECT_FALSE(fs::exists("results"));
}

TEST_F(Leaderboard, StartsThatAreNotAsManyAsPinnedAreRefused) {
  pin();
  const std::string pinned = content("configs/suites/tiny.yaml");
  folder_.write("configs/suites/tiny.yaml",
                std::regex_replace(pinned, std::regex("starts: \\d+"), "starts: 4"));
  EXPECT_THAT(refusal(run("run --quiet --suite tiny@1 --method few --out results")),
              HasSubstr("starts with seed 1, and 4 are pinned"));
}

TEST_F(Leaderboard, ImportedPosesAreJudgedLikeOnesOwn) {
  pin();
  run_and_add();
  // The declared poses of the run itself, in the form of others.
  std::string csv =
      "\xEF\xBB\xBF"
      "case,start,step,x,y,yaw_deg,declared,seed\n";
  for (const int seed : {1, 2}) {
    for (const Json& trial : json_lines(fmt::format("results/few_small_room_seed-{}/trials.jsonl", seed))) {
      if (!trial.contains("pose")) continue;
      const Json& pose = trial.at("pose");
      csv += fmt::format("small_room,{},{},{},{},{},1,{}\n", trial.at("trial").get<int>(),
                         trial.at("steps").get<int>() - 1, pose.at("x").get<double>(),
                         pose.at("y").get<double>(),
                         pose.at("theta").get<double>() * 180.0 / 3.141592653589793, seed);
    }
  }
  good(import(csv));
  EXPECT_THAT(refusal(run("leaderboard import poses.csv --suite tiny --method ../evil")),
              HasSubstr("'../evil' is no name of a method"));
  EXPECT_FALSE(fs::exists("leaderboard/evil.json"));
  const Json theirs = json("leaderboard/tiny@1/theirs.json").at("results");
  Json ours = entry().at("results");
  for (Json& result : ours) result.erase("ms");
  EXPECT_EQ(theirs, ours);
  const Json renewal = json_lines("leaderboard/history.jsonl").back();
  EXPECT_EQ(renewal.at("method"), "theirs");
  EXPECT_TRUE(std::regex_match(renewal.at("date").get<std::string>(), std::regex("\\d{4}-\\d\\d-\\d\\d")));
}

TEST_F(Leaderboard, WhatIsWrongWithImportedRowsIsSaidOfEach) {
  pin();
  const std::string head = "case,seed,start,step,x,y,yaw_deg,declared\n";
  const std::string row = "small_room,1,0,0,1,3,0,1\n";
  EXPECT_THAT(import(head + row + "small_room,1,999,0,1,3,0,1\n").err,
              HasSubstr("poses.csv:3: error: the case small_room has no start 999: they are 0 to "));
  EXPECT_THAT(import(head + row + row).err,
              HasSubstr("poses.csv:3: error: step 0 of start 0 of small_room is there "
                        "twice (first in line 2)"));
  EXPECT_THAT(import(head + "small_room,1,0,0,nan,3,0,1\n").err,
              HasSubstr("poses.csv:2: error: x: 'nan' is no finite number"));
  EXPECT_THAT(
      import(head + "small_room,1,0,5,1,3,0,1\n").err,
      HasSubstr("poses.csv:2: error: start 0 of small_room has 5 steps, from 0 on; there is no step 5"));
  EXPECT_THAT(import(head + "large_room,1,0,0,1,3,0,1\n").err, HasSubstr("tiny@1 has no case 'large_room'"));
  EXPECT_THAT(import(head + "small_room,3,0,0,1,3,0,1\n").err, HasSubstr("tiny@1 has no seed 3"));
  EXPECT_THAT(import("case,start,step,x,y,declared\n").err,
              HasSubstr("poses.csv:1: error: has no column 'yaw_deg'"));
  EXPECT_THAT(import(head + "small_room,1,0\n").err,
              HasSubstr("has 3 values, and the first line names 8 columns"));
  EXPECT_THAT(import(head).err, HasSubstr("has no rows"));
  EXPECT_FALSE(fs::exists("leaderboard"));
}

TEST_F(Leaderboard, PosesOfAnotherFrameAreToldByHowTheyFit) {
  pin();
  run_and_add();
  good(import(moved_references(0.0)));
  EXPECT_THAT(refusal(import(moved_references(7.0))),
              HasSubstr("theirs.json: error: is there already; --force replaces it"))
      << "before any pose is judged";
  const std::string moved = refusal(import(moved_references(7.0), " --force"));
  EXPECT_TRUE(
      std::regex_search(moved, std::regex("its poses are of another frame: \\d+ of \\d+ fit if all are "
                                          "turned by -?0.0 deg and moved by \\(-7.00, -?0.00\\) m")))
      << moved;
}

TEST_F(Leaderboard, ExportWritesPlainFilesWithoutReferences) {
  pin();
  good(run("leaderboard export tiny@1 --out plain"));
  for (const std::string name : {"map.yaml", "map.pgm", "map.pcd", "drive.mcap", "scans/odometry.tum"})
    EXPECT_TRUE(fs::exists("plain/small_room_seed-2/" + name)) << name;
  EXPECT_FALSE(fs::exists("plain/small_room_seed-2/scans/reference.tum"));
  EXPECT_THAT(run("bag info plain/small_room_seed-2/drive.mcap").out,
              testing::AllOf(HasSubstr("/points"), Not(HasSubstr("/reference"))));
  const std::string starts = content("plain/starts.csv");
  EXPECT_THAT(starts, HasSubstr("case,seed,folder,start,scan,steps\nsmall_room,1,small_room_seed-1,0,0,5\n"));
  std::ifstream odometry("plain/small_room_seed-2/scans/odometry.tum");
  std::size_t scans = 0;
  for (std::string line; std::getline(odometry, line); ++scans)
    EXPECT_TRUE(fs::exists("plain/small_room_seed-2/scans/" + line.substr(0, line.find(' ')) + ".pcd"));
  EXPECT_GT(scans, 10U);
  EXPECT_EQ(run("leaderboard export tiny@1 --out plain").exit_code, 2);
  EXPECT_THAT(run("leaderboard export tiny@1 plain").err, HasSubstr("-o says what to write"));
  good(run("leaderboard export tiny@1 --force -o plain"));
}

/// A Python that has numpy; empty if there is none.
std::string python_with_numpy() {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (std::system((std::string(python) + " -c 'import numpy' 2>/dev/null").c_str()) == 0) return python;
  }
  return "";
}

TEST_F(Leaderboard, TheExampleInPythonFindsMostStartsOfASmallRoom) {
  const std::string python = python_with_numpy();
  if (python.empty()) GTEST_SKIP() << "there is no Python with numpy";
  pin();
  good(run("leaderboard export tiny --out plain"));
  const std::string script = GLOCAL_SOURCE_DIR "/examples/python/particle_filter.py";
  ASSERT_EQ(std::system((python + " " + script + " plain poses.csv").c_str()), 0);
  const Answer imported = good(run("leaderboard import poses.csv --suite tiny --method particle_filter"));
  std::smatch counts;
  ASSERT_TRUE(std::regex_search(imported.out, counts, std::regex("(\\d+) wrong, (\\d+) right")));
  EXPECT_LE(std::stoi(counts[1]), 2);
  EXPECT_GE(std::stoi(counts[2]), 20);
}

}  // namespace
}  // namespace glocal::test::leaderboard_test
