#include "evaluation/results/results_folder.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "glocal/error.hpp"
#include "temporary_folder.hpp"

namespace glocal::test::results_folder_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A folder as glocal run leaves it, with two trials.
class ResultsFolder : public testing::Test {
 protected:
  ResultsFolder() { write_results("run"); }

  void write_results(const std::string& name) const {
    fs::create_directory(temporary_.path() / name);
    temporary_.write(name + "/summary.json", R"({"name": "lab", "seed": 7, "complete": true})");
    temporary_.write(name + "/provenance.json",
                     R"({"host": "h", "cpu": "c", "threads": 2, "inputs_sha256": {"/lab.log": "abc"}})");
    temporary_.write(name + "/effective.yaml",
                     "seed: 7\nmap:\n  carmen_log:\n    path: \"/lab.log\"\n    segments: [[0, 0.5]]\n");
    temporary_.write(
        name + "/trials.jsonl",
        R"({"trial":0,"start":{"sample":0,"distance_m":0.0,"stamp":5.5,"reference":{"x":1,"y":2,"theta":0.5}},)"
        R"("outcome":"right","steps":4,"distance_m":1.25,"translation_error_m":0.1,"rotation_error_deg":2})"
        "\n"
        R"({"trial":1,"start":{"sample":9,"distance_m":6.5,"stamp":8},"outcome":"failed","steps":0,"distance_m":0})"
        "\n");
    temporary_.write(name + "/steps.jsonl", step(0, 1) + step(0, 5) + step(0, 3));
  }

  static std::string step(int trial, int match_ms) {
    return R"({"trial":)" + std::to_string(trial) + R"(,"stage_ms":{"local_map":0.5,"match":)" +
           std::to_string(match_ms) + R"(,"cluster":0.25,"rate":0.25}})" + "\n";
  }

  [[nodiscard]] fs::path folder() const { return temporary_.path() / "run"; }

  /// What is said of the folder when it is read.
  [[nodiscard]] std::string fault() const {
    try {
      static_cast<void>(read_results(folder()));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder temporary_;
};

TEST_F(ResultsFolder, IsReadWithTheTimesOfItsSteps) {
  const StoredRun results = read_results(folder());
  EXPECT_EQ(results.experiment, "lab");
  EXPECT_EQ(results.seed, 7U);
  EXPECT_TRUE(results.complete);
  EXPECT_EQ(results.machine, (Machine{"h", "c", 2}));
  ASSERT_EQ(results.trials.size(), 2U);
  const auto& [start, right] = *results.trials.begin();
  EXPECT_EQ(start.sample, 0);
  EXPECT_EQ(start.stamp, 5.5);
  EXPECT_EQ(right.outcome, Outcome::right);
  EXPECT_EQ(right.steps, 4.0);
  EXPECT_EQ(right.distance_m, 1.25);
  EXPECT_EQ(right.translation_error_m, 0.1);
  EXPECT_EQ(right.rotation_error_deg, 2.0);
  ASSERT_TRUE(right.start_reference);
  EXPECT_EQ(right.start_reference->y, 2.0);
  EXPECT_EQ(right.step_ms, 4.0);  // Of 2, 6 and 4.
  const TrialResult& failed = results.trials.at({9, 6.5, 8.0});
  EXPECT_EQ(failed.outcome, Outcome::failed);
  EXPECT_EQ(failed.step_ms, std::nullopt);
  EXPECT_EQ(failed.translation_error_m, std::nullopt);
}

TEST_F(ResultsFolder, KnowsItsSettingsByPathAndItsFilesByContent) {
  const auto settings = read_results(folder()).settings;
  EXPECT_EQ(settings.at("seed").text, "7");
  EXPECT_EQ(settings.at("map.carmen_log.segments[0][1]").identity, "0.5");
  EXPECT_EQ(settings.at("map.carmen_log.path").text, "/lab.log");
  EXPECT_EQ(settings.at("map.carmen_log.path").identity, "abc");
}

TEST_F(ResultsFolder, NeedsNoSteps) {
  fs::remove(folder() / "steps.jsonl");
  EXPECT_EQ(read_results(folder()).trials.begin()->second.step_ms, std::nullopt);
}

TEST_F(ResultsFolder, MissesItsFilesByName) {
  for (const char* file : {"trials.jsonl", "effective.yaml", "provenance.json", "summary.json"}) {
    fs::remove(folder() / file);
    EXPECT_THAT(fault(), AllOf(HasSubstr(file), HasSubstr("cannot be read; name a folder that glocal run")))
        << file;
  }
}

TEST_F(ResultsFolder, NamesTheLineThatIsNoTrial) {
  const std::string start =
      R"({"trial":0,"start":{"sample":0,"distance_m":0,"stamp":0},"steps":1,"distance_m":0,)";
  const std::string trial = start + R"("outcome":"right"})" + "\n";
  for (const auto& [text, what] :
       {std::pair<std::string, std::string>{trial + "{\n", "trials.jsonl:2: error: is no line of results"},
        {start + R"("outcome":"rigth"})",
         "trials.jsonl:1: error: is no line of results (there is no outcome 'rigth')"},
        {trial + trial,
         "trials.jsonl:2: error: is no line of results (an earlier trial starts at the same place)"},
        {"[]\n", "trials.jsonl:1"},
        {trial + start + R"("outcome":3})", "trials.jsonl:2"}}) {
    temporary_.write("run/trials.jsonl", text);
    EXPECT_THAT(fault(), HasSubstr(what)) << text;
  }
}

TEST_F(ResultsFolder, NamesOtherFilesThatAreNotAsTheyWereLeft) {
  temporary_.write("run/steps.jsonl", "{\"trial\": 0}\n");
  EXPECT_THAT(fault(), HasSubstr("steps.jsonl:1: error: is no line of results"));
  temporary_.write("run/effective.yaml", "seed: [\n");
  EXPECT_THAT(fault(), HasSubstr("effective.yaml:"));
  temporary_.write("run/summary.json", "{\"name\": 3}");
  EXPECT_THAT(fault(), AllOf(HasSubstr("summary.json: error: is not as glocal run leaves it"),
                             HasSubstr("run the experiment again")));
}

TEST_F(ResultsFolder, IsFoundInAFolderOfVariants) {
  write_results("another");
  write_results(".hidden");
  fs::create_directory(temporary_.path() / "notes");
  EXPECT_THAT(results_folders(folder()), ElementsAre(folder()));
  EXPECT_THAT(results_folders(temporary_.path()), ElementsAre(temporary_.path() / "another", folder()));
  EXPECT_THROW(static_cast<void>(results_folders(temporary_.path() / "notes")), ConfigError);
  EXPECT_THROW(static_cast<void>(results_folders(temporary_.path() / "missing")), ConfigError);
}

}  // namespace
}  // namespace glocal::test::results_folder_test
