// glocal run --shard, status and merge: several processes, one folder.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <thread>

#include "app/room.hpp"

namespace glocal::test::shard_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Shards : public Room {
 protected:
  Shards() {
    write_experiment("trials: {every_scan: 2, max_steps: 6}\n",
                     "variants: {grid: {localizer.matcher.ransam.iterations: [10000, 20000]}}\n");
  }

  [[nodiscard]] Answer run_shard(const std::string& shard, const std::string& options = "--quiet") const {
    return run_room("shared", "--shard " + shard + " " + options);
  }

  [[nodiscard]] Answer merge(const std::string& options = "--quiet") const {
    return run("merge " + file("shared") + " " + options);
  }

  [[nodiscard]] Json status() const { return Json::parse(run("status " + file("shared") + " --json").out); }

  [[nodiscard]] std::vector<fs::path> journals() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(file("shared/.shards/journals"))) {
      if (entry.path().extension() != ".index") files.push_back(entry.path());
    }
    return files;
  }

  /// Identities of finished trials, as often as they are there.
  [[nodiscard]] std::multiset<std::string> finished() const {
    std::multiset<std::string> trials;
    for (const auto& [id, rest] : finished_trials("shared/.shards/journals")) trials.insert(id);
    return trials;
  }

  /// Starts the only shard, and ends it when some trials are finished; with all its processes, or the first
  /// alone. What waitpid() tells of it.
  [[nodiscard]] int end_shard(int signal, bool all) const {
    const std::string experiment = file("room.yaml");
    const std::string out = file("shared");
    const pid_t child = fork();
    if (child == 0) {
      setpgid(0, 0);
      execl(GLOCAL_PROGRAM, GLOCAL_PROGRAM, "run", experiment.c_str(), "--quiet", "--shard", "1/1", "--out",
            out.c_str(), nullptr);
      _exit(127);
    }
    for (int ms = 0; ms < 30'000; ++ms) {
      if (finished().size() >= 3) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(all ? -child : child, signal);
    int ended = 0;
    waitpid(child, &ended, 0);
    return ended;
  }

  void expect_result_of_one_machine() const {
    good(run_room("one"));
    for (const std::string variant : {"/iterations-10000", "/iterations-20000"}) {
      expect_same_results("one" + variant, "shared" + variant);
      EXPECT_EQ(content(file("one" + variant + "/effective.yaml")),
                content(file("shared" + variant + "/effective.yaml")));
      EXPECT_EQ(origin("one" + variant), origin("shared" + variant));
    }
    EXPECT_EQ(content(file("one/variants.json")), content(file("shared/variants.json")));
  }

  /// What results are of, but for when and by which command.
  [[nodiscard]] Json origin(const std::string& folder) const {
    Json origin = json(folder + "/provenance.json");
    EXPECT_EQ(origin.erase("began"), 1U);
    EXPECT_EQ(origin.erase("command"), 1U);
    return origin;
  }
};

TEST_F(Shards, TogetherLeaveWhatOneMachineLeaves) {
  for (const char* shard : {"2/3", "3/3", "1/3"}) ASSERT_EQ(run_shard(shard).exit_code, 0) << shard;
  const Answer merged = good(merge(""));
  EXPECT_THAT(merged.out, HasSubstr("\niterations-10000 "));
  expect_result_of_one_machine();
  const auto trials = finished();
  EXPECT_EQ(trials.size(), 22U);
  EXPECT_EQ(std::set<std::string>(trials.begin(), trials.end()).size(), 22U) << "each is run once";
}

TEST_F(Shards, OfAnExperimentWithoutVariants) {
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n");
  for (const char* shard : {"1/2", "2/2"}) good(run_shard(shard, "--quiet --jobs 2"));
  good(merge());
  ASSERT_EQ(merge().exit_code, 0) << "once more, over what is there";
  good(run_room("one"));
  expect_same_results("one", "shared");
  EXPECT_FALSE(fs::exists("shared/.shards/merged"));
  good(run("summarize shared"));
}

TEST_F(Shards, OtherNumbersOfThreadsAreTold) {
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n");
  good(run_shard("1/2", "--quiet --threads 1"));
  good(run_shard("2/2", "--quiet --threads 2"));
  good(merge());
  EXPECT_EQ(json("shared/provenance.json")["threads"], 0);
  good(run("summarize shared"));
}

TEST_F(Shards, OtherNumbersOfShardsDoOnlyWhatIsMissing) {
  good(run_shard("1/4"));
  const auto first = finished();
  ASSERT_GE(first.size(), 4U);
  for (const char* shard : {"1/2", "2/2", "1/1"}) good(run_shard(shard));
  EXPECT_EQ(finished().size(), 22U);
  const std::size_t files = journals().size();
  const Answer again = good(run_shard("1/1", ""));
  EXPECT_THAT(again.err, HasSubstr("shard 1/1: 0 of its 22 trials are to be run"));
  EXPECT_EQ(journals().size(), files) << "whoever has nothing to do writes nothing";
  good(merge());
  expect_result_of_one_machine();
}

TEST_F(Shards, MoreVariantsAndSeedsAreAddedToWhatIsThere) {
  good(run_shard("1/1"));
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n",
                   "variants: {grid: {localizer.matcher.ransam.iterations: [10000, 15000, 20000]}}\n");
  const Answer more = good(run_shard("1/1", ""));
  EXPECT_THAT(more.err, HasSubstr("11 of its 33 trials are to be run"));
  good(merge());
}

TEST_F(Shards, WhatIsMissingIsListed) {
  good(run_shard("1/2"));
  EXPECT_THAT(refusal(merge(), 3),
              AllOf(HasSubstr("incomplete: 12 of 22 trials are missing\n"),
                    HasSubstr("  iterations-10000: trials 1, 3, 5, 7, 9, 10\n"), Not(HasSubstr("at work"))));
  EXPECT_EQ(json("shared/iterations-10000/summary.json")["complete"], false);
  EXPECT_EQ(status()["all"]["missing"], 12);
  EXPECT_EQ(status()["all"]["done"], 10);
  good(run_shard("2/2"));
  good(merge());
  expect_result_of_one_machine();
}

TEST_F(Shards, AnInterruptedOneEndsInGoodOrder) {
  // A scheduler's signal reaches all processes of a job; that of a terminal, too.
  const int ended = end_shard(SIGTERM, true);
  ASSERT_TRUE(WIFEXITED(ended));
  EXPECT_EQ(WEXITSTATUS(ended), 3);
  const auto before = finished();
  ASSERT_LT(before.size(), 22U);
  for (const fs::path& journal : journals()) EXPECT_EQ(journal.extension(), ".jsonl");
  EXPECT_EQ(status()["live_shards"], 0);
  good(run_shard("1/1"));
  EXPECT_EQ(finished().size(), 22U);
  good(merge());
  expect_result_of_one_machine();
}

TEST_F(Shards, AKilledOneLosesNothingThatWasFinished) {
  ASSERT_TRUE(WIFSIGNALED(end_shard(SIGKILL, false)));
  const auto before = finished();
  ASSERT_LT(before.size(), 22U);

  EXPECT_THAT(refusal(merge(), 3),
              HasSubstr("1 shard is still at work (or ended without a word in the last two min"));
  // Long ago, by the clock of the folder's server: machines need not have the same time.
  for (const fs::path& journal : journals())
    fs::last_write_time(journal, fs::last_write_time(journal) - std::chrono::minutes(3));
  EXPECT_THAT(merge().err, Not(HasSubstr("at work")));
  EXPECT_EQ(status()["silent"].size(), 1U);
  EXPECT_EQ(status()["live_shards"], 0);

  // Half a line at the end, as a power failure leaves it.
  std::ofstream(journals().front(), std::ios::app) << "0badc0de trial 12";
  good(run_shard("1/1"));
  const auto after = finished();
  EXPECT_EQ(after.size(), 22U);
  for (const std::string& trial : before) EXPECT_EQ(after.count(trial), 1U) << "run twice";
  good(merge());
  expect_result_of_one_machine();
}

TEST_F(Shards, ADamagedLineIsRunAgain) {
  good(run_shard("1/1"));
  const fs::path journal = journals().front();
  std::string text = content(journal);
  const std::size_t place = text.find("undecided");
  ASSERT_NE(place, std::string::npos);
  text[place] = 'U';
  std::ofstream(journal) << text;
  const Answer again = good(run_shard("1/1", ""));
  EXPECT_THAT(again.err, AllOf(HasSubstr("the line is damaged (its checksum is another one)"),
                               HasSubstr("1 of its 22 trials are to be run")));
}

TEST_F(Shards, AFolderOfAnotherExperimentIsRefused) {
  good(run_shard("1/2"));
  const auto expect_refused = [&](const std::string& options, const std::string& why) {
    const Answer answer = run_shard("2/2", options);
    EXPECT_EQ(answer.exit_code, 2) << options;
    EXPECT_THAT(answer.err,
                HasSubstr(file("shared") + ": error: output: the folder was made otherwise: " + why));
  };
  expect_refused("--set localizer.matcher.ransam.relation_cell=0.2",
                 "variant 'iterations-10000': localizer.matcher.ransam.relation_cell is ");
  expect_refused("--seed 2", "variant 'iterations-10000': seed is 1 there and 2 here; choose another folder");
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n");
  expect_refused("", "with a variant 'iterations-10000', which is not here");
  EXPECT_EQ(finished().size(), 10U);
}

TEST_F(Shards, AChangedInputIsRefused) {
  good(run_shard("1/2"));
  std::ofstream("world.yaml", std::ios::app) << "# a change\n";
  EXPECT_THAT(refusal(run_shard("2/2")),
              HasSubstr("world.yaml: error: has changed since the first shard has run"));
  EXPECT_EQ(finished().size(), 10U);
}

TEST_F(Shards, BadNumbersAreRefused) {
  for (const char* shard : {"0/3", "4/3", "3", "1/0", "a/b", "1/2/3", "-1/2", "1/99999999"}) {
    const Answer answer = run_shard(shard);
    EXPECT_EQ(answer.exit_code, 2) << shard;
    EXPECT_THAT(answer.err, HasSubstr("--shard " + std::string(shard) + ": error: is no shard; give"));
  }
  EXPECT_FALSE(fs::exists("shared"));
  EXPECT_EQ(run_shard("1/2", "--force").exit_code, 2);
  EXPECT_EQ(run("run room.yaml --shard 1/2").exit_code, 2) << "without --out";
}

TEST_F(Shards, FaultsOfTheExperimentLeaveNothing) {
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n",
                   "variants: {list: {far: {trials.starts_m: [1000], trials.every_scan: 0}}}\n");
  EXPECT_THAT(refusal(run_shard("1/2")), HasSubstr("variant 'far': "));
  EXPECT_FALSE(fs::exists("shared"));
}

// Journals are read in the order of their names, whichever was first.
TEST_F(Shards, MergedAgainWithOtherNumbersOfThreadsTheyAreTheSameRun) {
  good(run_shard("2/2", "--quiet --threads 2"));
  EXPECT_EQ(merge().exit_code, 3);
  good(run_shard("1/2", "--quiet --threads 1"));
  good(merge());
}

TEST_F(Shards, ResultsOfAnotherRunAreNotReplaced) {
  good(run_shard("1/1"));
  good(run_room("shared", "--quiet --seed 2"));
  EXPECT_THAT(refusal(merge()),
              HasSubstr("iterations-10000: error: output: the folder has results of another run"));
  EXPECT_EQ(json("shared/iterations-10000/summary.json")["seed"], 2);
  // Nor are those of a run that was interrupted: it can be gone on with.
  Json summary = json("shared/iterations-10000/summary.json");
  summary["complete"] = false;
  std::ofstream("shared/iterations-10000/summary.json") << summary;
  EXPECT_THAT(refusal(merge()),
              HasSubstr("iterations-10000: error: output: the folder has results of another run"));
  good(merge("--quiet --force"));
  EXPECT_EQ(json("shared/iterations-10000/summary.json")["seed"], 1);
  good(run_room("before", "--quiet --seed 2"));
  EXPECT_THAT(refusal(run_room("before", "--quiet --shard 1/2")),
              HasSubstr("before/iterations-10000: error: output: the folder has results of a run without"));
  EXPECT_FALSE(fs::exists("before/.shards"));
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n");
  good(run_room("plain"));
  EXPECT_EQ(run_room("plain", "--shard 1/1").exit_code, 2) << "results of a run without shards are there";
}

TEST_F(Shards, AMergeThatWasKilledIsDoneAgain) {
  write_experiment("trials: {every_scan: 6, max_steps: 5}\n");
  good(run_shard("1/1"));
  good(merge());
  const std::string trials = content("shared/trials.jsonl");
  // As if it had not come to the last two files.
  fs::create_directory("shared/.shards/merged");
  for (const std::string name : {"summary.json", "trials.jsonl"})
    fs::rename("shared/" + name, "shared/.shards/merged/" + name);
  good(merge());
  EXPECT_EQ(content("shared/trials.jsonl"), trials);
  EXPECT_TRUE(fs::exists("shared/summary.json"));
  EXPECT_FALSE(fs::exists("shared/.shards/merged"));
}

TEST_F(Shards, AFolderWithoutShardsIsRefused) {
  for (const std::string command : {"status ", "merge "}) {
    EXPECT_THAT(refusal(run(command + "nowhere")), HasSubstr("no shards have run here"));
  }
  good(run_shard("1/2"));
  std::ofstream("shared/.shards/manifest.json") << "{";
  EXPECT_THAT(refusal(run("status shared")), HasSubstr("manifest.json: error: is damaged"));
}

TEST_F(Shards, AFullDiskEndsOneShardAndOthersGoOn) {
  // 64 blocks of 1024 bytes: the limit of the shell stands for the disk.
  const std::string limited = "ulimit -f 64; " GLOCAL_PROGRAM " run " + file("room.yaml") +
                              " --quiet --shard 1/2 --out " + file("shared") + " 2>said";
  EXPECT_EQ(std::system(("bash -c '" + limited + "'").c_str()), 1 << 8);
  EXPECT_THAT(content("said"), AllOf(HasSubstr("cannot write: File too large"),
                                     HasSubstr("finished trials are kept: give the same command again")));
  good(run_shard("2/2"));
  good(run_shard("1/2"));
  good(merge());
  expect_result_of_one_machine();
}

TEST_F(Shards, AReportShowsWhatIsThereSoFar) {
  good(run_shard("1/2"));
  const Answer report = good(run("report shared -o so_far.html"));
  EXPECT_THAT(report.err, HasSubstr("as far as it is: 10 of 22 trials"));
  EXPECT_THAT(content("so_far.html"), HasSubstr("iterations-10000"));
  const Answer sweep = good(run("sweep shared"));
  EXPECT_THAT(sweep.out, HasSubstr("2 runs without all trials"));
  EXPECT_FALSE(fs::exists("shared/iterations-10000")) << "the folder is left as it is";
  // Runs of one name go by their folders: those that were given, not those that are put together.
  fs::create_directory(file("copy"));
  fs::copy("shared", file("copy/shared"), fs::copy_options::recursive);
  good(run("report shared " + file("copy/shared") + " -o both.html"));
  EXPECT_THAT(content("both.html"), HasSubstr(file("copy/shared/iterations-10000")));
  good(run_shard("2/2"));
  good(merge());
  EXPECT_EQ(run("report shared -o all.html").err, "");
}

TEST_F(Shards, WhatCannotBeShownLeavesNothingBehind) {
  good(run_shard("1/2"));
  fs::create_directory("tmp");
  fs::copy("shared", "begun", fs::copy_options::recursive);
  fs::remove_all("begun/.shards/journals");
  ::setenv("TMPDIR", file("tmp").c_str(), 1);
  const Answer report = run("report shared begun -o both.html");
  ::unsetenv("TMPDIR");
  EXPECT_THAT(refusal(report), HasSubstr("begun: error: no trial has come to an end yet"));
  EXPECT_TRUE(fs::is_empty("tmp"));
}

TEST_F(Shards, WatchedStatusEndsWhenAllIsDone) {
  good(run_shard("1/1"));
  const Answer answer = good(run("status shared --watch"));
  EXPECT_THAT(answer.out, HasSubstr("22 of 22 trials done"));
}

}  // namespace
}  // namespace glocal::test::shard_test
