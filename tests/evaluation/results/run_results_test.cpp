// The journal of a run, and what is put together from it.
#include "evaluation/results/run_results.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "evaluation/results/file_io.hpp"
#include "evaluation/results/records.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/writers.hpp"
#include "files.hpp"

namespace glocal::test::run_results_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// A trial of two steps that was declared rightly in the second; numbers that no short text has.
TrialRecord trial_record(std::size_t trial) {
  TrialRecord record;
  record.trial = trial;
  record.outcome = Outcome::right;
  record.steps = 2;
  record.distance_m = 1.0 / 3.0 + static_cast<double>(trial);
  record.error = error_of(0.1, 1.0 / 7.0);
  record.records = {step_record(0, {1, 2, 0.5}), step_record(1, {1, 2, 0.5})};
  record.records[1].result.stage_ms = {0.1, 1e-17, 2.0 / 3.0, 4.0};
  record.records[1].result.verdict.kind = VerdictKind::localized;
  record.records[1].error = error_of(0.1, 1.0 / 7.0);
  return record;
}

class RunResultsTest : public testing::Test {
 protected:
  /// Runs these trials of four, and leaves the folder as a killed run would.
  void leave_unfinished(const std::vector<std::size_t>& trials) {
    OutputFolder folder(path(), false);
    for (const std::size_t trial : trials) keep(folder, trial);
  }

  [[nodiscard]] fs::path path() const { return folder_ / "results"; }
  [[nodiscard]] fs::path unfinished(const std::string& name = "") const {
    return folder_ / (".results.unfinished/" + name);
  }

  static bool take_up(const fs::path& /*folder*/, bool /*is_final*/) { return true; }

  std::vector<std::size_t> to_run() {
    OutputFolder folder(path(), false, take_up);
    folder.keep_unfinished();
    return missing_trials(folder, 4, warn_);
  }

  void keep(OutputFolder& folder, std::size_t trial) {
    keep_trial(folder, TrialCollector(config_).finish(trial_record(trial)));
  }

  [[nodiscard]] nlohmann::ordered_json put_together_all(OutputFolder& folder) const {
    return put_together(folder, {{"name", "a"}, {"seed", 1}, {"steps", config_.steps}}, 4, true,
                        [&](std::size_t trial) { return read_entry(folder.unfinished(), trial); });
  }

  TemporaryFolder folder_;
  OutputConfig config_;
  std::vector<std::string> warnings_;
  std::function<void(const std::string&)> warn_ = [this](const std::string& text) {
    warnings_.push_back(text);
  };
};

TEST_F(RunResultsTest, FilesAreInTheOrderOfTrialsWhoeverWroteThem) {
  leave_unfinished({3, 1});
  OutputFolder folder(path(), false, take_up);
  EXPECT_THAT(missing_trials(folder, 4, warn_), ElementsAre(0, 2));
  keep(folder, 2);
  keep(folder, 0);
  const auto json = put_together_all(folder);
  folder.commit();

  Summary expected;
  std::string trials;
  std::string steps;
  for (std::size_t trial = 0; trial < 4; ++trial) {
    const TrialRecord record = trial_record(trial);
    expected.add(figures_of(record));
    trials += trial_line(record);
    steps += step_line(trial, record.records[0]) + step_line(trial, record.records[1]);
  }
  EXPECT_EQ(content_of(path() / "trials.jsonl"), trials);
  EXPECT_EQ(content_of(path() / "steps.jsonl"), steps);
  for (int trial = 0; trial < 4; ++trial) {
    for (const char* what : {"estimate", "localized"})
      EXPECT_TRUE(fs::exists(path() / fmt::format("trajectories/trial_{:04}_{}.tum", trial, what)));
  }
  EXPECT_EQ(json, expected.to_json({{"name", "a"}, {"seed", 1}}, true));
  EXPECT_EQ(content_of(path() / "summary.json"), json.dump(2) + "\n");
  EXPECT_EQ(json["after_declaration"]["steps"], 4);
}

TEST_F(RunResultsTest, AreWholeWithoutStepLinesToo) {
  config_.steps = false;
  leave_unfinished({0, 1, 2, 3});
  OutputFolder folder(path(), false, take_up);
  const auto json = put_together_all(folder);
  EXPECT_EQ(json["trials"]["right"], 4);
  EXPECT_EQ(json["stage_ms"]["local_map"]["max"], 1.0);
  EXPECT_FALSE(fs::exists(unfinished("steps.jsonl")));
}

TEST_F(RunResultsTest, WhatIsDamagedIsRunAgainWithAWarning) {
  leave_unfinished({0, 1, 2, 3});
  EXPECT_THAT(to_run(), ElementsAre());
  EXPECT_THAT(warnings_, IsEmpty());
  // The entry of one trial under the name of another.
  fs::copy_file(unfinished("journal/trial_0003.json"), unfinished("journal/trial_0000.json"),
                fs::copy_options::overwrite_existing);
  fs::resize_file(unfinished("journal/trial_0001.json"), 100);
  fs::remove(unfinished("trajectories/trial_0002_estimate.tum"));
  std::ofstream(unfinished("trajectories/trial_0003_estimate.tum"), std::ios::app) << "1 2 3\n";
  EXPECT_THAT(to_run(), ElementsAre(0, 1, 2, 3));
  const auto warning = [&](int trial, const std::string& what) {
    return fmt::format("{}:1: {}; trial {} runs again",
                       unfinished(fmt::format("journal/trial_000{}.json", trial)).string(), what, trial);
  };
  EXPECT_THAT(
      warnings_,
      ElementsAre(warning(0, "the entry is of trial 3"),
                  warning(1, "the entry is damaged: its checksum is another one"),
                  warning(2, "the trial's trajectories/trial_0002_estimate.tum is missing"),
                  warning(3,
                          "the trial's trajectories/trial_0003_estimate.tum is damaged: its checksum is "
                          "another one")));
}

TEST_F(RunResultsTest, AnEditedEntryIsRunAgain) {
  leave_unfinished({0, 1, 2, 3});
  const fs::path file = unfinished("journal/trial_0001.json");
  std::string text = content_of(file);
  const std::size_t right = text.find("\"right\"");
  ASSERT_NE(right, std::string::npos);
  std::ofstream(file) << text.replace(right, 7, "\"wrong\"");
  EXPECT_THAT(to_run(), ElementsAre(1));
  EXPECT_THAT(warnings_, SizeIs(1));
}

TEST(Checksum, IsTheOneOfGzip) {
  EXPECT_EQ(checksum("123456789"), "cbf43926");
  EXPECT_EQ(checksum(""), "00000000");
}

}  // namespace
}  // namespace glocal::test::run_results_test
