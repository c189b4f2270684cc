#include "glocal/run_experiment.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "evaluation/results/results_folder.hpp"
#include "files.hpp"
#include "glocal/builtin.hpp"

namespace glocal::test::run_experiment_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// Trials in a room, all of them short.
class RunExperiment : public testing::Test {
 protected:
  RunExperiment() {
    register_builtin_strategies(catalog_);
    folder_.write("world.yaml",
                  "size: [12, 6]\n"
                  "walls:\n"
                  "  - {points: [[0, 0], [12, 0], [12, 4], [7, 6], [0, 6]], closed: true}\n"
                  "free_from: [[1, 1]]\n"
                  "way_points: [[1, 3], [10, 3], [10, 1]]\n");
    write_experiment("");
  }

  void write_experiment(const std::string& variants) const {
    folder_.write("room.yaml",
                  "schema: 1\n"
                  "name: room\n"
                  "map: {simulation: {world: world.yaml}}\n"
                  "observations: {simulation: {world: world.yaml}}\n"
                  "trials: {every_scan: 6, max_steps: 4}\n"
                  "localizer: {matcher: {ransam: {iterations: 5000}}}\n"
                  "output: {maps: none}\n" +
                      variants);
  }

  [[nodiscard]] RunResult run(const RunOptions& options, const RunObserver& observer = {}) const {
    return run_experiment(folder_.path() / "room.yaml", {}, catalog_, options, observer);
  }

  /// Of which a trial is finished at least.
  void run_a_part(const RunOptions& options) const {
    bool is_begun = false;
    RunObserver observer;
    observer.trial = [&](const TrialEnd&) { is_begun = true; };
    observer.stop = [&] { return is_begun; };
    EXPECT_FALSE(run(options, observer).complete);
  }

  [[nodiscard]] RunOptions to(const std::string& name) const { return {.out = folder_.path() / name}; }

  TemporaryFolder folder_;
  Catalog catalog_;
};

TEST_F(RunExperiment, LeavesResultsAndTellsThem) {
  std::map<Outcome, std::size_t> outcomes;
  std::vector<VariantBegin> begun;
  std::size_t steps = 0;
  RunObserver observer;
  observer.begin = [&](const VariantBegin& variant) { begun.push_back(variant); };
  observer.step = [&](std::size_t, const StepResult&) { ++steps; };
  observer.trial = [&](const TrialEnd& trial) { ++outcomes[trial.outcome]; };
  const RunResult result = run(to("out"), observer);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.folder, folder_.path() / "out");
  ASSERT_THAT(result.variants, SizeIs(1));
  const VariantResult& variant = result.variants.front();
  EXPECT_EQ(variant.name, "");
  EXPECT_EQ(variant.summary, folder_.path() / "out/summary.json");
  EXPECT_EQ(variant.right, outcomes[Outcome::right]);
  EXPECT_EQ(variant.wrong, outcomes[Outcome::wrong]);
  EXPECT_EQ(variant.undecided, outcomes[Outcome::undecided]);
  ASSERT_THAT(begun, SizeIs(1));
  EXPECT_EQ(begun.front().trials, variant.trials);
  EXPECT_EQ(begun.front().finished, 0U);
  // What is in the folder says the same.
  const StoredRun stored = read_results(result.folder);
  EXPECT_THAT(stored.trials, SizeIs(variant.trials));
  EXPECT_EQ(stored.summary["trials"]["right"], variant.right);
  EXPECT_EQ(stored.summary["steps"], steps);
  EXPECT_TRUE(stored.provenance["inputs_sha256"].contains((folder_.path() / "room.yaml").string()));
}

TEST_F(RunExperiment, IsStoppedAndGoneOnWith) {
  std::size_t finished = 0;
  RunObserver observer;
  observer.trial = [&](const TrialEnd&) { ++finished; };
  observer.stop = [&] { return finished == 2; };
  std::vector<std::string> warnings;
  observer.warn = [&](const std::string& text) { warnings.push_back(text); };
  const RunResult stopped = run(to("out"), observer);
  EXPECT_FALSE(stopped.complete);
  EXPECT_FALSE(stopped.variants.front().complete);
  EXPECT_EQ(stopped.variants.front().trials, 2U);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("interrupted: 2 of ")));
  EXPECT_TRUE(is_results_folder(folder_.path() / "out"));
  EXPECT_FALSE(read_results(folder_.path() / "out").complete);

  VariantBegin begun;
  std::vector<std::string> notes;
  RunObserver again;
  again.begin = [&](const VariantBegin& variant) { begun = variant; };
  again.note = [&](const std::string& text) { notes.push_back(text); };
  const RunResult whole = run(to("out"), again);
  EXPECT_TRUE(whole.complete);
  EXPECT_EQ(begun.finished, 2U);
  EXPECT_EQ(whole.variants.front().trials, begun.trials);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("goes on where an earlier run has stopped: 2 of ")));
  EXPECT_EQ(read_results(folder_.path() / "out").machine.jobs, 1U);
}

TEST_F(RunExperiment, TellsTheLoadOfOthersOnlyWhereItRanAllTrials) {
  // Less than a second says nothing.
  const auto summary_of_a_run = [&](bool is_stopped) {
    bool is_begun = false;
    RunObserver observer;
    observer.trial = [&](const TrialEnd&) {
      if (!is_begun) std::this_thread::sleep_for(std::chrono::milliseconds(1100));
      is_begun = true;
    };
    observer.stop = [&] { return is_stopped && is_begun; };
    EXPECT_EQ(run(to("out"), observer).complete, !is_stopped);
    return read_results(folder_.path() / "out").summary;
  };
  const auto stopped = summary_of_a_run(true);
  if (!stopped.contains("others_load")) GTEST_SKIP() << "the system does not tell";
  EXPECT_FALSE(summary_of_a_run(false).contains("others_load"));
}

TEST_F(RunExperiment, TellsThatItsTrialsRanSideBySideAtTimes) {
  run_a_part(to("out"));
  RunOptions options = to("out");
  options.jobs = 2;
  EXPECT_TRUE(run(options).complete);
  EXPECT_EQ(read_results(folder_.path() / "out").machine.jobs, 0U);
}

TEST_F(RunExperiment, AnInterruptedOneOfOtherValuesIsNotReplaced) {
  run_a_part(to("out"));
  write_experiment("seed: 77\n");
  EXPECT_THAT(error_of([&] { return run(to("out")); }),
              HasSubstr("output: the folder has results of another run: it is of other values"));
}

TEST_F(RunExperiment, WhatIsInNoFileIsAnInput) {
  write_experiment("variants: {list: {one: {}}}\n");
  RunOptions options = to("all");
  options.sources = {{"the clusterer 'mine'", "code"}};
  EXPECT_TRUE(run(options).complete);
  EXPECT_EQ(read_results(folder_.path() / "all/one").provenance["inputs_sha256"]["the clusterer 'mine'"],
            "code");
  EXPECT_TRUE(run(options).complete);
  options.sources.begin()->second = "other code";
  EXPECT_THAT(config_error(folder_.path(), [&] { static_cast<void>(run(options)); }),
              HasSubstr("the clusterer 'mine' has changed since"));
}

TEST_F(RunExperiment, RunsVariantsInTheOrderOfTheFile) {
  write_experiment("variants: {list: {zebra: {}, ant: {seed: 2}}}\n");
  RunOptions only = to("all");
  only.only = {"ant"};
  EXPECT_TRUE(run(only).complete);
  std::vector<std::string> notes;
  RunObserver observer;
  observer.note = [&](const std::string& text) { notes.push_back(text); };
  const RunResult all = run(to("all"), observer);
  ASSERT_THAT(all.variants, SizeIs(2));
  EXPECT_EQ(all.variants[0].name, "zebra");
  EXPECT_EQ(all.variants[1].name, "ant");
  EXPECT_EQ(all.variants[1].folder, folder_.path() / "all/ant");
  EXPECT_THAT(notes, ElementsAre("ant: kept, as an earlier run has finished it"));
  only.only = {"bee"};
  EXPECT_THROW(static_cast<void>(run(only)), ConfigError);
}

TEST_F(RunExperiment, StopsBetweenVariants) {
  write_experiment("variants: {list: {one: {}, two: {seed: 2}}}\n");
  bool begun = false;
  RunObserver observer;
  observer.begin = [&](const VariantBegin&) { begun = true; };
  observer.stop = [&] { return begun; };
  const RunResult result = run(to("all"), observer);
  EXPECT_FALSE(result.complete);
  ASSERT_THAT(result.variants, SizeIs(1));
  EXPECT_FALSE(result.variants.front().complete);
  EXPECT_FALSE(fs::exists(folder_.path() / "all/two"));
}

TEST_F(RunExperiment, AnyNumberOfJobsTellsOfEveryTrial) {
  RunOptions options = to("three");
  options.jobs = 3;
  std::mutex mutex;
  std::vector<std::size_t> trials;
  RunObserver observer;
  observer.trial = [&](const TrialEnd& trial) {
    const std::lock_guard lock(mutex);
    trials.push_back(trial.trial);
  };
  const RunResult three = run(options, observer);
  EXPECT_THAT(trials, SizeIs(three.variants.front().trials));
  options = to("none");
  options.jobs = 0;
  EXPECT_EQ(run(options).variants.front().right, three.variants.front().right);
}

TEST_F(RunExperiment, WritesNothingForWhatIsWrong) {
  const auto overridden = [&] {
    static_cast<void>(
        run_experiment(folder_.path() / "room.yaml", {{"trials.max_steps", "-1"}}, catalog_, to("out")));
  };
  EXPECT_THROW(overridden(), ConfigError);
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  static_cast<void>(run(to("out")));
  EXPECT_THAT(config_error(folder_.path(), [&] { static_cast<void>(run(to("out"))); }),
              HasSubstr("out: error: output: the folder exists and is not empty"));
  RunOptions force = to("out");
  force.force = true;
  EXPECT_TRUE(run(force).complete);
}

TEST_F(RunExperiment, ThrowsWhatAnObserverThrows) {
  RunObserver observer;
  observer.step = [](std::size_t, const StepResult&) { throw std::runtime_error("enough"); };
  EXPECT_THROW(static_cast<void>(run(to("out"), observer)), std::runtime_error);
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

}  // namespace
}  // namespace glocal::test::run_experiment_test
