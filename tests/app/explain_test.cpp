// glocal explain.
#include <gmock/gmock.h>

#include "app/program.hpp"

namespace glocal::test {
namespace {

using testing::HasSubstr;

class ExplainCommand : public CommandLine {
 protected:
  [[nodiscard]] std::string folder() const { return folder_.path() / "results"; }

  /// One trial of six steps in the simulated lab.
  void run_lab(const std::string& options = "") const {
    const Answer answer =
        run("run " + std::string(GLOCAL_SOURCE_DIR) + "/configs/experiments/paper_lab.yaml --quiet --out " +
            folder() + " --set 'trials={starts_m: [0], max_steps: 6}' " + options);
    ASSERT_EQ(answer.exit_code, 0) << answer.err;
  }

  [[nodiscard]] std::string lost(int step) const {
    const Answer answer = run("explain " + folder() + " --trial 0 --step " + std::to_string(step));
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    return answer.out.substr(answer.out.find("lost"));
  }
};

TEST_F(ExplainCommand, MakesTheStepAgain) {
  run_lab();
  const std::string trial = content(folder() + "/trials.jsonl");
  const std::size_t steps_at = trial.find("\"steps\":") + 8;
  const int last = std::stoi(trial.substr(steps_at)) - 1;
  const Answer answer = run("explain " + folder() + " --trial 0 --step " + std::to_string(last));
  const std::size_t why_at = trial.find("\"why\":\"") + 7;
  EXPECT_THAT(answer.out, HasSubstr("localized: " + trial.substr(why_at, trial.find('"', why_at) - why_at)));
  EXPECT_THAT(lost(last), HasSubstr("nowhere: declared, and right"));
  EXPECT_THAT(lost(0), HasSubstr("not declared"));
}

TEST_F(ExplainCommand, TellsWhatWasNeverDrawnFromWhatWasRejected) {
  run_lab("--set localizer.matcher.ransam.iterations=1");
  EXPECT_THAT(lost(0), HasSubstr("never drawn"));
  std::filesystem::remove_all(folder());
  run_lab("--set localizer.threshold_policy.fixed.omega_max=1.0");
  EXPECT_THAT(lost(0), HasSubstr("rejected"));
}

TEST_F(ExplainCommand, ReportsFaults) {
  EXPECT_THAT(run("explain " + folder() + " --trial 0 --step 0").err, HasSubstr("holds no results"));
  run_lab();
  Answer answer = run("explain " + folder() + " --trial 1 --step 0");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("there is no trial 1: the last one is 0"));
  answer = run("explain " + folder() + " --trial 0 --step 6");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("trial 0 has no step 6"));
}

}  // namespace
}  // namespace glocal::test
