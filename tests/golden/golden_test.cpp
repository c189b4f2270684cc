// Experiments give the results they gave before.
//
// To make the stored results anew after a change that is meant to change them:
//   GLOCAL_MAKE_GOLDEN=1 ctest --preset release -R Golden
// and say in the commit why they changed.
#include <gmock/gmock.h>

#include "app/room.hpp"

namespace glocal::test::golden_test {
namespace {

/// A run whose results are stored.
struct GoldenRun {
  std::string experiment;
  std::string options = {};
  bool needs_datasets = false;
};

class Golden : public CommandLine, public testing::WithParamInterface<GoldenRun> {
 protected:
  /// What the run comes to: of a single trial with its steps, else of each.
  [[nodiscard]] Json result() const {
    good(run("run " GLOCAL_SOURCE_DIR "/configs/experiments/" + GetParam().experiment +
             ".yaml --quiet --out results " + GetParam().options));
    const std::vector<Json> trials = json_lines("results/trials.jsonl");
    return trials.size() == 1 ? with_steps(trials.front(), "results/steps.jsonl") : declarations(trials);
  }

  [[nodiscard]] static std::string stored_file() {
    return GLOCAL_SOURCE_DIR "/tests/golden/" + GetParam().experiment + ".json";
  }

 private:
  static Json declarations(const std::vector<Json>& trials) {
    Json result;
    for (const Json& trial : trials) {
      Json& one = result["trial_" + std::to_string(trial["trial"].get<int>())];
      one = {{"outcome", trial["outcome"]}, {"steps", trial["steps"]}};
      if (trial.contains("pose")) one["declared_pose"] = trial["pose"];
    }
    return result;
  }

  static Json with_steps(const Json& trial, const std::string& file) {
    std::ifstream steps(file);
    Json result = {{"outcome", trial["outcome"]}, {"steps_to_verdict", trial["steps"]}, {"steps", 0}};
    Json step;
    for (std::string line; std::getline(steps, line);) {
      step = Json::parse(line);
      if (step["step"] == 0) {
        result["clusters_in_first_step"] = step["clusters"];
        result["hypotheses_in_first_step"] = step["hypotheses"];
      }
      result["steps"] = step["step"].get<int>() + 1;
    }
    if (trial.contains("pose")) result["declared_pose"] = trial["pose"];
    result["last_verdict"] = step["verdict"];
    if (step.contains("estimate")) result["last_estimate"] = step["estimate"];
    return result;
  }
};

/// Takes poses (m, rad) out of a result: they may differ by rounding on other processors.
Json take_poses(Json& result) {
  Json poses = Json::object();
  for (const char* key : {"declared_pose", "last_estimate"}) {
    if (result.contains(key)) poses[key] = result[key];
    result.erase(key);
  }
  for (auto& [name, trial] : result.items()) {
    if (!trial.is_object()) continue;
    const Json of_trial = take_poses(trial);
    for (const auto& [key, pose] : of_trial.items()) {
      std::string full_key = name;
      full_key.append(".").append(key);
      poses[full_key] = pose;
    }
  }
  return poses;
}

TEST_P(Golden, TheResultIsTheStoredOne) {
  if (GetParam().needs_datasets && std::getenv("GLOCAL_DATASETS") == nullptr)
    GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  Json result = this->result();
  if (std::getenv("GLOCAL_MAKE_GOLDEN") != nullptr) {
    std::ofstream(stored_file()) << result.dump(2) << '\n';
    GTEST_SKIP() << "wrote " << stored_file();
  }
  ASSERT_TRUE(std::filesystem::exists(stored_file())) << "make it as the head of this test says";
  Json stored = Json::parse(content(stored_file()));
  const Json poses = take_poses(result);
  const Json stored_poses = take_poses(stored);
  EXPECT_EQ(result, stored);
  ASSERT_EQ(poses.size(), stored_poses.size());
  for (const auto& [key, pose] : stored_poses.items()) {
    ASSERT_TRUE(poses.contains(key)) << key;
    for (const char* part : {"x", "y", "theta"}) {
      EXPECT_NEAR(poses[key][part].get<double>(), pose[part].get<double>(), 1e-3) << key << "." << part;
    }
  }
}

std::string name_of(const testing::TestParamInfo<GoldenRun>& info) {
  return info.param.experiment;
}

INSTANTIATE_TEST_SUITE_P(
    Experiments, Golden,
    testing::Values(GoldenRun{"paper_simulation"}, GoldenRun{"paper_symmetry"}, GoldenRun{"paper_lab"},
                    GoldenRun{"paper_symmetry_indexed"},
                    GoldenRun{
                        "sim_kidnapped_mcl",
                        "--set trials.whole=false --set trials.every_m=1000 --set trials.max_steps=100"},
                    GoldenRun{"intel", "--set trials.every_m=48", true}),
    name_of);

}  // namespace
}  // namespace glocal::test::golden_test
