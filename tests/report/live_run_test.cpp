#include "report/live_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "evaluation/results/records.hpp"
#include "points.hpp"

namespace glocal::test::live_run_test {
namespace {

using Json = nlohmann::ordered_json;

/// Six samples, two trials: the first begins at sample 1, the second at sample 4.
LoadedExperiment two_starts() {
  LoadedExperiment loaded;
  MapData map;
  map.points = points_at({{0, 0}, {0.5F, 0}});
  loaded.map = std::make_shared<const GlobalMap>(std::move(map));
  for (int i = 0; i < 6; ++i) {
    Sample sample;
    sample.observation.stamp = 10.0 + i;
    sample.observation.scan.hits = points_at({{static_cast<float>(i), 2}});
    sample.map_from_robot = Pose2{0.5 * i, 0.0, 0.0};
    loaded.drive.samples.push_back(sample);
    loaded.drive.path_m.push_back(0.5 * i);
  }
  loaded.starts = {1, 4};
  return loaded;
}

class LiveRunTest : public testing::Test {
 protected:
  void begin() { live_.begin("mine", "results/mine", {{"seed", {"7", "7"}}}, loaded_); }

  void step(std::size_t trial, std::size_t number, const Points& local_map = {}) {
    live_.step(trial, step_record(number, {1, 2, 3}), local_map, {.finished = 0, .trials = 2});
  }

  void finish(std::size_t trial, std::size_t steps) {
    TrialRecord record;
    record.trial = trial;
    record.start_sample = loaded_.starts[trial];
    record.steps = steps;
    record.outcome = Outcome::right;
    live_.finish(record, {.finished = 1, .trials = 2, .remaining_s = 1.5});
  }

  [[nodiscard]] Json data() { return live_.news()->data; }

  LoadedExperiment loaded_ = two_starts();
  LiveRun live_{"lab"};
};

TEST_F(LiveRunTest, HasARunWithoutTrialsBeforeItBegins) {
  const Json json = data();
  EXPECT_EQ(json["format"], 1);
  EXPECT_EQ(json["live"], Json::parse(R"({"experiment": "lab", "variant": "", "trials_done": 0, "trials": 0,
                                          "finished": false, "version": 1})"));
  EXPECT_EQ(json["maps"], Json::array());
  EXPECT_EQ(json["runs"], Json::parse(R"([{"name": "lab", "folder": "", "settings": {}, "trials": []}])"));
}

TEST_F(LiveRunTest, HasTheLatestMapAndScanOfARunningTrialAndAllItsSteps) {
  begin();
  step(1, 0, points_at({{9, 9}}));
  step(1, 1, points_at({{3, 1}, {1, 1}}));
  const Json json = data();
  EXPECT_EQ(json["maps"], Json::parse(R"([{"x": [0, 500], "y": [0, 0], "spacing_m": 0.5}])"));
  const Json& run = json["runs"][0];
  EXPECT_EQ(run["name"], "mine");
  EXPECT_EQ(run["map"], 0);
  EXPECT_EQ(run["settings"], Json::parse(R"({"seed": {"text": "7"}})"));
  ASSERT_EQ(run["trials"].size(), 1U);
  const Json& trial = run["trials"][0];
  EXPECT_EQ(trial["trial"], 1);
  EXPECT_FALSE(trial.contains("outcome"));
  EXPECT_EQ(trial["start"], Json::parse(R"({"sample": 4, "distance_m": 2.0, "stamp": 14.0,
                                            "reference": {"x": 2.0, "y": 0.0, "theta": 0.0}})"));
  EXPECT_EQ(trial["columns"]["step"], Json::parse("[0, 1]"));
  EXPECT_EQ(
      trial["local_map"],
      Json::parse(R"({"steps": [1], "x": [1000, 3000], "y": [1000, 1000], "from": [0, 0], "to": [1, 1]})"));
  EXPECT_EQ(trial["scans"], Json::parse(R"({"steps": [1], "first": [0, 1], "x": [5000], "y": [2000]})"));
}

TEST_F(LiveRunTest, SaysWhereATrialInSpaceBegan) {
  loaded_.drive.samples[4].map_from_robot = Pose3(Vector3(2.0, 0.0, 1.5));
  loaded_.drive.samples[4].map = "upstairs";
  begin();
  StepRecord record = step_record(0, {1, 2, 3});
  record.result.motion = Motion::upright;
  live_.step(1, record, {}, {.finished = 0, .trials = 2});
  const Json start = data()["runs"][0]["trials"][0]["start"];
  EXPECT_EQ(start["reference"]["z"], 1.5);
  EXPECT_EQ(start["map"], "upstairs");
}

TEST_F(LiveRunTest, HasFinishedTrialsAsTheyAreWritten) {
  begin();
  step(1, 0);
  step(0, 0);
  step(0, 1);
  finish(0, 2);
  const Json json = data();
  EXPECT_EQ(json["live"]["trials_done"], 1);
  EXPECT_EQ(json["live"]["remaining_s"], 1.5);
  const Json& trials = json["runs"][0]["trials"];
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[0]["outcome"], "right");
  EXPECT_EQ(trials[0]["steps"], 2);
  EXPECT_EQ(trials[0]["columns"]["step"], Json::parse("[0, 1]"));
  EXPECT_FALSE(trials[0].contains("local_map"));
  EXPECT_FALSE(trials[1].contains("outcome"));
}

TEST_F(LiveRunTest, TakesATrialThatFailedBeforeItsFirstStepWasOver) {
  begin();
  finish(1, 0);
  EXPECT_EQ(data()["runs"][0]["trials"][0]["columns"]["step"], Json::array());
}

TEST_F(LiveRunTest, ForgetsAVariantWhenTheNextBegins) {
  begin();
  step(0, 0);
  finish(0, 1);
  step(1, 0);
  live_.begin("yours", "results/yours", {}, loaded_);
  const Json json = data();
  EXPECT_EQ(json["live"]["variant"], "yours");
  EXPECT_EQ(json["runs"][0]["trials"], Json::array());
}

TEST_F(LiveRunTest, TellsOnlyWhatIsNew) {
  begin();
  const std::uint64_t version = live_.news()->version;
  EXPECT_EQ(live_.news(version), std::nullopt);
  EXPECT_EQ(live_.news(version + 1)->version, version);
  step(0, 0);
  EXPECT_EQ(live_.news(version)->version, version + 1);
  EXPECT_EQ(live_.news()->data["live"]["version"], version + 1);
  live_.end();
  EXPECT_EQ(live_.news(version + 1)->data["live"]["finished"], true);
}

TEST_F(LiveRunTest, KeepsNoMoreStepsThanItCanTell) {
  begin();
  loaded_.starts.assign(3, 0);
  loaded_.drive.samples.resize(4000);
  for (std::size_t trial = 0; trial < 3; ++trial) {
    for (std::size_t i = 0; i < 4000; ++i) step(trial, i);
    finish(trial, 4000);
  }
  const Json trials = data()["runs"][0]["trials"];
  for (std::size_t trial = 0; trial < 3; ++trial)
    EXPECT_EQ(trials[trial].contains("columns"), trial >= 1) << trial;
}

TEST_F(LiveRunTest, WaitsOnlyForThoseWhoWatch) {
  live_.wait_until_told(std::chrono::hours(1));
  live_.told(live_.news()->version);
  live_.end();
  std::thread watcher([&] { live_.told(live_.news()->version); });
  live_.wait_until_told(std::chrono::hours(1));
  watcher.join();
}

TEST_F(LiveRunTest, MayBeAskedWhileTrialsRun) {
  begin();
  std::thread trial([&] {
    for (std::size_t i = 0; i < 300; ++i) {
      const std::size_t sample = i % 5;  // the drive has no more
      if (sample == 0 && i > 0) finish(0, 5);
      step(0, sample, points_at({{1, static_cast<float>(i)}}));
    }
  });
  std::uint64_t version = 0;
  for (int i = 0; i < 50; ++i) {
    const auto news = live_.news(version);
    if (!news) continue;
    EXPECT_GT(news->version, version);
    version = news->version;
    for (const Json& one : news->data["runs"][0]["trials"])
      EXPECT_EQ(one["columns"]["step"].size(), one["columns"]["why"].size());
  }
  trial.join();
}

}  // namespace
}  // namespace glocal::test::live_run_test
