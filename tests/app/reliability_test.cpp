// glocal reliability.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "app/result_lines.hpp"

namespace glocal::test::reliability_test {
namespace {

using testing::HasSubstr;

class ReliabilityCommand : public CommandLine {
 protected:
  /// The results of one short trial in the simulated lab.
  void run_lab(const std::string& options = "") const {
    good(run("run " GLOCAL_SOURCE_DIR
             "/configs/experiments/paper_lab.yaml --quiet --out results --set 'trials={starts_m: [0], "
             "max_steps: 4}' --set localizer.verdict_rule=staged_margin"
             " --set localizer.matcher=indexed_ransam --set 'localizer.threshold_policy={fixed: {omega_max: "
             "0.1}}' " +
             options));
  }
};

nlohmann::json step(int trial, int number, double confidence, double translation_m, double rotation_deg) {
  return {{"trial", trial},
          {"step", number},
          {"confidence", confidence},
          {"translation_error_m", translation_m},
          {"rotation_error_deg", rotation_deg},
          {"verdict", "searching"}};
}

nlohmann::json declared(const char* outcome) {
  return {{"outcome", outcome}, {"confidence", 0.95}};
}

/// One that declares a pose 0.3 m off along x, with a variance of 0.01 m^2 there.
nlohmann::json declaring(int trial, int number) {
  nlohmann::json line = step(trial, number, 0.95, 0.3, 0.0);
  line["verdict"] = "localized";
  line["estimate"] = {{"x", 5.3}, {"y", 2.0}, {"theta", 0.5}};
  line["reference"] = {{"x", 5.0}, {"y", 2.0}, {"theta", 0.5}};
  line["covariance"] = {0.01, 0.0, 0.0, 0.04, 0.0, 0.001};
  return line;
}

TEST_F(ReliabilityCommand, ReadsWhatRunHasLeft) {
  run_lab();
  const Answer answer = good(run("reliability results"));
  EXPECT_THAT(answer.out, HasSubstr("1 trials: 1 right, 0 wrong"));
  EXPECT_THAT(answer.out, HasSubstr("Normalised error squared of right declarations"));
}

TEST_F(ReliabilityCommand, CountsByConfidence) {
  run_lab();
  // Four declared with 0.95, three of them rightly; one undecided. Of trial 0 the first step counts, of trial
  // 1 the second.
  replace_lines("results",
                {declared("right"),
                 declared("right"),
                 declared("right"),
                 declared("wrong"),
                 {{"outcome", "undecided"}}},
                {step(0, 0, 0.2, 0.1, 1.0), step(0, 1, 0.8, 9.0, 1.0), step(1, 0, 0.6, 9.0, 1.0),
                 step(1, 1, 0.25, 0.1, 11.0)});
  const Answer answer = good(run("reliability results"));
  EXPECT_THAT(answer.out, HasSubstr("5 trials: 3 right, 1 wrong (20.00 %"));
  EXPECT_THAT(answer.out, HasSubstr("0.90 - 0.97        4  0.950    0.750"));
  EXPECT_THAT(answer.out, HasSubstr("0.10 - 0.30        2  0.225    0.500"));
}

TEST_F(ReliabilityCommand, TellsTrialsThatNothingJudges) {
  run_lab();
  const nlohmann::json undecided = {{"outcome", "undecided"}}, failed = {{"outcome", "failed"}};
  replace_lines("results", {declared("right"), declared("declared"), undecided, failed, failed}, {});
  EXPECT_THAT(run("reliability results").out,
              HasSubstr("5 trials: 1 right, 0 wrong (0.00 %, 95 % interval 0.00 to 48.99 %), 1 without a "
                        "declaration, 1 declared without a reference pose, 2 failed\n"));
  replace_lines("results", {declared("declared"), declared("declared")}, {});
  EXPECT_THAT(run("reliability results").out,
              HasSubstr("2 trials: 0 without a declaration, 2 declared without a reference pose\n"));
}

TEST_F(ReliabilityCommand, WeighsErrorsByCovarianceAndReference) {
  run_lab();
  // Only the first declared step of a trial counts, and only within half a metre and 10 degrees.
  nlohmann::json wrong = declaring(2, 0);
  wrong["translation_error_m"] = 3.0;
  replace_lines("results", {declared("right"), declared("right"), declared("wrong")},
                {step(0, 0, 0.2, 0.1, 1.0), declaring(0, 1), declaring(0, 2), declaring(1, 0), wrong});
  // 0.3^2 / 0.01 = 9; with 0.1 m of the reference 0.3^2 / (0.01 + 0.01) = 4.5.
  EXPECT_THAT(run("reliability results").out,
              HasSubstr("declarations: 9.00 in the median, 9.00 in the mean; if the covariances are right, "
                        "0.00 to 5.46 and 0.15 to 5.85 in 9 of 10 cases"));
  EXPECT_THAT(run("reliability --reference-deviation 0.1 results").out,
              HasSubstr("declarations: 4.50 in the median"));
  EXPECT_EQ(run("reliability --reference-deviation -1 results").exit_code, 2);
}

TEST_F(ReliabilityCommand, NeedsStepsAndEachFolderOnce) {
  run_lab();
  EXPECT_THAT(run("reliability results results/").err, HasSubstr("is named twice"));
  const Answer pooled = run("reliability " + folder_.path().string());
  EXPECT_THAT(pooled.out, HasSubstr("1 trials: 1 right")) << pooled.err;
  std::filesystem::remove_all("results");
  run_lab("--set output.steps=false");
  EXPECT_THAT(run("reliability results").err, HasSubstr("again with --set output.steps=true"));
}

TEST_F(ReliabilityCommand, NamesTheLineThatIsNoResult) {
  EXPECT_EQ(run("reliability results").exit_code, 2);
  run_lab();
  std::ofstream("results/trials.jsonl", std::ios::app) << "{\"outcome\": \n";
  const std::string said = refusal(run("reliability results"));
  EXPECT_THAT(said, HasSubstr("trials.jsonl:2"));
  EXPECT_THAT(said, HasSubstr("run the experiment again"));
}

}  // namespace
}  // namespace glocal::test::reliability_test
