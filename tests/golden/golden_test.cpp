// The simulated experiments give the results they gave before.
//
// To make the stored results anew after a change that is meant to change them:
//   GLOCAL_MAKE_GOLDEN=1 ctest --preset release -R Golden
// and say in the commit why they changed.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace glocal::test::golden_test {
namespace {

using Json = nlohmann::ordered_json;

class Golden : public CommandLine, public testing::WithParamInterface<std::string> {
 protected:
  /// What a run of the experiment comes to.
  [[nodiscard]] Json result() const {
    const std::string out = folder_.path() / "results";
    const Answer answer =
        run("run " GLOCAL_SOURCE_DIR "/configs/experiments/" + GetParam() + ".yaml --quiet --out " + out);
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    const Json trial = Json::parse(content(out + "/trials.jsonl"));
    std::ifstream steps(out + "/steps.jsonl");
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

  [[nodiscard]] static std::string stored_file() {
    return GLOCAL_SOURCE_DIR "/tests/golden/" + GetParam() + ".json";
  }
};

/// Takes poses (m, rad) out of a result: they may differ by rounding on other processors.
Json take_poses(Json& result) {
  Json poses = Json::object();
  for (const char* key : {"declared_pose", "last_estimate"}) {
    if (result.contains(key)) poses[key] = result[key];
    result.erase(key);
  }
  return poses;
}

TEST_P(Golden, TheResultIsTheStoredOne) {
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

std::string name_of(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}

INSTANTIATE_TEST_SUITE_P(Experiments, Golden,
                         testing::Values("paper_simulation", "paper_symmetry", "paper_lab"), name_of);

}  // namespace
}  // namespace glocal::test::golden_test
