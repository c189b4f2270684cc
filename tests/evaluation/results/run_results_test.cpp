// What is put together from journals.
#include "evaluation/results/run_results.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/file_io.hpp"
#include "evaluation/results/records.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/trial_output.hpp"
#include "evaluation/results/writers.hpp"
#include "files.hpp"

namespace glocal::test::run_results_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::IsEmpty;

/// A trial of two steps that was declared rightly in the second; numbers that no short text has.
TrialRecord trial_record(std::size_t trial) {
  TrialRecord record;
  record.trial = trial;
  record.outcome = Outcome::right;
  record.steps = 2;
  record.distance_m = 1.0 / 3.0 + static_cast<double>(trial);
  record.error = off_by(0.1, 1.0 / 7.0);
  record.records = {step_record(0, {1, 2, 0.5}), step_record(1, {1, 2, 0.5})};
  record.records[1].result.stage_ms = {0.1, 1e-17, 2.0 / 3.0, 4.0};
  record.records[1].result.verdict.kind = VerdictKind::localized;
  record.records[1].error = off_by(0.1, 1.0 / 7.0);
  return record;
}

class RunResultsTest : public testing::Test {
 protected:
  /// A process runs these trials of four.
  void run(const std::vector<std::size_t>& trials) const {
    Journal journal(folder_ / "journal", {}, 1);
    for (const std::size_t trial : trials)
      journal.finish(trial_id("v", trial, 7 * trial), 1.0,
                     TrialCollector(config_).finish(trial_record(trial)));
  }

  Json put_together_all() const {
    const JournalScan scan(folder_ / "journal", [](const std::string& text) { ADD_FAILURE() << text; });
    const JournaledTrials trials(scan, "v", {0, 7, 14, 21});
    EXPECT_THAT(trials.missing(), IsEmpty());
    OutputFolder folder(path(), false);
    Json summary = put_together(folder, {{"name", "a"}, {"seed", 1}, {"steps", config_.steps}}, trials, true);
    folder.commit();
    return summary;
  }

  [[nodiscard]] fs::path path() const { return folder_ / "results"; }

  TemporaryFolder folder_;
  OutputConfig config_;
};

TEST_F(RunResultsTest, FilesAreInTheOrderOfTrialsWhoeverRanThem) {
  run({3, 1});
  {
    const JournalScan scan(folder_ / "journal", [](const std::string& text) { ADD_FAILURE() << text; });
    EXPECT_THAT(JournaledTrials(scan, "v", {0, 7, 14, 21}).missing(), ElementsAre(0, 2));
    EXPECT_THAT(JournaledTrials(scan, "another", {0, 7}).missing(), ElementsAre(0, 1));
  }
  run({2, 0});
  const Json json = put_together_all();

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
  run({0, 1, 2, 3});
  const Json json = put_together_all();
  EXPECT_EQ(json["trials"]["right"], 4);
  EXPECT_EQ(json["stage_ms"]["local_map"]["max"], 1.0);
  EXPECT_FALSE(fs::exists(path() / "steps.jsonl"));
}

}  // namespace
}  // namespace glocal::test::run_results_test
