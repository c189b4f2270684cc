// glocal run after a run that was killed, and beside another one.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <map>
#include <thread>

#include "app/room.hpp"

namespace glocal::test::run_again_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RunAgain : public Room {
 protected:
  RunAgain() { write_experiment("trials: {every_scan: 2, max_steps: 6}\n"); }

  /// Starts a run of room.yaml and kills it with this signal once `wanted` holds.
  void kill_run(const std::string& out, int with, const std::function<bool()>& wanted,
                const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {GLOCAL_PROGRAM, "run",   file("room.yaml"),
                                      "--quiet",      "--out", file(out)};
    words.insert(words.end(), options.begin(), options.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      execv(GLOCAL_PROGRAM, arguments.data());
      _exit(127);
    }
    int status = 0;
    while (!wanted()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      ASSERT_EQ(waitpid(child, &status, WNOHANG), 0) << "the run ended before it was killed";
    }
    ::kill(child, with);
    waitpid(child, &status, 0);
  }

  [[nodiscard]] std::multimap<std::string, std::string> journal(const std::string& folder) const {
    return finished_trials(folder + "/journal");
  }

  /// Lines as they are, with their times: a trial that was run twice has others.
  void expect_steps_of(const std::multimap<std::string, std::string>& journal,
                       const std::string& results) const {
    const std::string steps = content(file(results + "/steps.jsonl"));
    for (const auto& [id, text] : journal) {
      const std::string of_trial = Json::parse(text.substr(text.find('{')))["step_lines"];
      EXPECT_FALSE(of_trial.empty());
      EXPECT_NE(steps.find(of_trial), std::string::npos) << id;
    }
  }
};

TEST_F(RunAgain, AKilledRunIsGoneOnWithAndNothingIsRunTwice) {
  for (const std::string jobs : {"1", "2"}) {
    const std::string out = "jobs" + jobs;
    kill_run(out, SIGKILL, [&] { return journal("." + out + ".unfinished").size() >= 3; }, {"--jobs", jobs});
    EXPECT_FALSE(fs::exists(out));
    const auto before = journal("." + out + ".unfinished");
    const Answer answer = good(run_room(out, "--jobs " + jobs));
    EXPECT_THAT(
        answer.err,
        HasSubstr("goes on where an earlier run has stopped: " + std::to_string(before.size()) + " of "));
    expect_steps_of(before, out);
    EXPECT_FALSE(fs::exists(out + "/journal"));
    EXPECT_FALSE(fs::exists("." + out + ".unfinished"));
    EXPECT_FALSE(fs::exists("." + out + ".lock"));
  }
  good(run_room("whole"));
  expect_same_results("whole", "jobs1");
  expect_same_results("whole", "jobs2");
}

TEST_F(RunAgain, AKilledVariantIsGoneOnWith) {
  write_experiment("trials: {every_scan: 2, max_steps: 6}\noutput: {steps: false}\n",
                   "variants: {grid: {localizer.matcher.ransam.iterations: [10000, 20000]}}\n");
  kill_run("all", SIGKILL, [&] { return !journal("all/.iterations-20000.unfinished").empty(); });
  const auto before = journal("all/.iterations-20000.unfinished");
  const Answer answer = good(run_room("all", ""));
  EXPECT_THAT(answer.err, AllOf(HasSubstr("iterations-10000: kept"),
                                HasSubstr("iterations-20000: goes on where an earlier run has stopped: " +
                                          std::to_string(before.size()) + " of ")));
  good(run_room("whole"));
  EXPECT_EQ(content("all/iterations-20000/trials.jsonl"), content("whole/iterations-20000/trials.jsonl"));
  EXPECT_EQ(without_times(json("all/iterations-20000/summary.json")),
            without_times(json("whole/iterations-20000/summary.json")));
}

TEST_F(RunAgain, WhatIsDamagedIsRunAgain) {
  kill_run("a", SIGKILL, [&] { return journal(".a.unfinished").size() >= 3; });
  const auto before = journal(".a.unfinished");
  const fs::path file_of_journal = fs::directory_iterator(file(".a.unfinished/journal"))->path();
  std::string text = content(file_of_journal);
  // One of the two lines is a whole trial, the other one has a file of another trial.
  for (const std::string& id : {before.begin()->first, before.rbegin()->first}) {
    const bool whole = id == before.begin()->first;
    const std::size_t line = text.find((whole ? " trial " : " file ") + id);
    ASSERT_NE(line, std::string::npos);
    text[line + 50] ^= 1;
  }
  std::ofstream(file_of_journal) << text;
  const Answer answer = good(run_room("a", ""));
  EXPECT_THAT(answer.err, AllOf(HasSubstr("stopped: " + std::to_string(before.size() - 2) + " of "),
                                HasSubstr("warning: " + file_of_journal.string() + ": byte "),
                                HasSubstr("the line is damaged (its checksum is another one)"),
                                HasSubstr("the line is damaged (a file of the trial is missing)")));
  good(run_room("whole"));
  expect_same_results("whole", "a");
}

TEST_F(RunAgain, AnInterruptedRunIsGoneOnWith) {
  kill_run("a", SIGINT, [&] { return journal(".a.unfinished").size() >= 2; });
  ASSERT_EQ(json("a/summary.json")["complete"], false);
  const auto before = journal("a");
  ASSERT_GE(before.size(), 2U);
  good(run_room("a"));
  expect_steps_of(before, "a");
  good(run_room("whole"));
  expect_same_results("whole", "a");
  EXPECT_EQ(run_room("a").exit_code, 2) << "what is complete is not run again";
}

/// One trial, long enough for the interrupt to come before its end.
class RunInterruptedAtOnce : public RunAgain {
 protected:
  /// `first` is the folder that the run begins with.
  void expect_to_go_on(const std::string& first, const std::vector<std::string>& options) const {
    const std::string out = first.substr(0, first.find('/'));
    const fs::path parent = fs::path(file(first)).parent_path();
    const fs::path begun =
        parent / ("." + fs::path(first).filename().string() + ".unfinished/provenance.json");
    std::string words = "--quiet";
    for (const std::string& option : options) words += " " + option;
    good(run_room("whole", words));
    for (const std::string force : {"", " --force"}) {
      kill_run(
          out, SIGINT, [&] { return fs::exists(begun); }, options);
      ASSERT_EQ(json(first + "/summary.json")["complete"], false);
      ASSERT_EQ(json(first + "/summary.json")["trials"]["count"], 0);
      good(run_room(out, words + force));
      expect_same_results("whole" + first.substr(out.size()), first);
      fs::remove_all(file(out));
    }
  }
};

TEST_F(RunInterruptedAtOnce, IsGoneOnWith) {
  write_experiment("trials: {every_m: 100, max_steps: 3}\n");
  expect_to_go_on("a", {"--set", "localizer.matcher.ransam.iterations=1000000"});
}

TEST_F(RunInterruptedAtOnce, IsGoneOnWithInVariants) {
  write_experiment("trials: {every_m: 100, max_steps: 3}\n",
                   "variants: {grid: {localizer.matcher.ransam.iterations: [1000000, 10000]}}\n");
  expect_to_go_on("a/iterations-1000000", {});
}

TEST_F(RunAgain, AKillBetweenTheSummaryAndTheEndLosesNothing) {
  good(run_room("a"));
  const std::string steps = content("a/steps.jsonl");
  fs::rename("a", ".a.unfinished");
  good(run_room("a", ""));
  EXPECT_EQ(content("a/steps.jsonl"), steps) << "no step was run again";
  EXPECT_FALSE(fs::exists(".a.unfinished"));
}

TEST_F(RunAgain, AnotherRunStartsAfreshAndSaysWhy) {
  const auto three = [&] { return journal(".a.unfinished").size() >= 3; };
  kill_run("a", SIGKILL, three);
  Answer answer = good(run_room("a", "--quiet --seed 2"));
  EXPECT_THAT(answer.err,
              HasSubstr("starts afresh: what an earlier run has left unfinished is dropped, as it "
                        "is of other values (effective.yaml)"));
  good(run_room("two", "--quiet --seed 2"));
  expect_same_results("two", "a");

  fs::remove_all("a");
  kill_run("a", SIGKILL, three);
  std::ofstream(file("world.yaml"), std::ios::app) << "# a change\n";
  answer = good(run_room("a"));
  EXPECT_THAT(answer.err, HasSubstr("as " + file("world.yaml") + " has changed since"));
}

TEST_F(RunAgain, TwoAtOnceAreRefused) {
  Answer second{};
  kill_run("a", SIGKILL, [&] {
    if (journal(".a.unfinished").empty()) return false;
    second = run_room("a");
    return true;
  });
  EXPECT_THAT(refusal(second), HasSubstr(file("a") + ": error: output: another run is writing this folder"));
  EXPECT_FALSE(journal(".a.unfinished").empty()) << "the first one's files are left alone";
}

TEST_F(RunAgain, AnyNumberOfJobsGivesTheSameResults) {
  good(run_room("one"));
  good(run_room("three", "--quiet --jobs 3 --threads 2 --set output.maps=all"));
  good(run_room("all_maps", "--quiet --set output.maps=all"));
  expect_same_results("all_maps", "three");
  EXPECT_EQ(lines("one/steps.jsonl"), lines("three/steps.jsonl"));
}

}  // namespace
}  // namespace glocal::test::run_again_test
