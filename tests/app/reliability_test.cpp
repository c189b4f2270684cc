// glocal reliability.
#include <gmock/gmock.h>

#include <fstream>

#include "app/program.hpp"

namespace glocal::test::reliability_test {
namespace {

using testing::HasSubstr;

class ReliabilityCommand : public CommandLine {
 protected:
  [[nodiscard]] std::string folder() const { return folder_.path() / "results"; }

  /// The results of one short trial in the simulated lab.
  void run_lab() const {
    const Answer answer =
        run("run " + std::string(GLOCAL_SOURCE_DIR) + "/configs/experiments/paper_lab.yaml --quiet --out " +
            folder() +
            " --set 'trials={starts_m: [0], max_steps: 4}' --set localizer.verdict_rule=staged_margin"
            " --set localizer.matcher=indexed_ransam --set 'localizer.threshold_policy={fixed: {omega_max: "
            "0.1}}'");
    ASSERT_EQ(answer.exit_code, 0) << answer.err;
  }

  void replace(const std::string& file, const std::string& text) const {
    std::ofstream(folder() + "/" + file) << text;
  }
};

TEST_F(ReliabilityCommand, ReadsWhatRunHasLeft) {
  run_lab();
  const Answer answer = run("reliability " + folder());
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("1 trials: 1 right, 0 wrong"));
  EXPECT_THAT(answer.out, HasSubstr("Normalised error squared of right declarations"));
}

TEST_F(ReliabilityCommand, CountsByConfidence) {
  run_lab();
  // Four declared with 0.95, three of them rightly; one undecided.
  replace("trials.jsonl",
          "{\"outcome\": \"right\", \"confidence\": 0.95, \"nees\": 2.0}\n"
          "{\"outcome\": \"right\", \"confidence\": 0.95, \"nees\": 5.5}\n"
          "{\"outcome\": \"right\", \"confidence\": 0.95, \"nees\": 4.5}\n"
          "{\"outcome\": \"wrong\", \"confidence\": 0.95, \"nees\": 900.0}\n"
          "{\"outcome\": \"undecided\"}\n");
  // Of trial 0 the first step counts, of trial 1 the second.
  replace(
      "steps.jsonl",
      "{\"trial\": 0, \"confidence\": 0.2, \"translation_error_m\": 0.1, \"rotation_error_deg\": 1.0}\n"
      "{\"trial\": 0, \"confidence\": 0.8, \"translation_error_m\": 9.0, \"rotation_error_deg\": 1.0}\n"
      "{\"trial\": 1, \"confidence\": 0.6, \"translation_error_m\": 9.0, \"rotation_error_deg\": 1.0}\n"
      "{\"trial\": 1, \"confidence\": 0.25, \"translation_error_m\": 0.1, \"rotation_error_deg\": 11.0}\n");
  const Answer answer = run("reliability " + folder());
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("5 trials: 3 right, 1 wrong (20.00 %"));
  EXPECT_THAT(answer.out, HasSubstr("0.90 - 0.97        4  0.950    0.750"));
  EXPECT_THAT(answer.out, HasSubstr("0.10 - 0.30        2  0.225    0.500"));
  EXPECT_THAT(answer.out, HasSubstr("declarations: 4.00 in the mean"));
}

TEST_F(ReliabilityCommand, NamesTheLineThatIsNoResult) {
  EXPECT_EQ(run("reliability " + folder()).exit_code, 2);
  run_lab();
  replace("trials.jsonl", "{\"outcome\": \"undecided\"}\n{\"outcome\": \n");
  const Answer answer = run("reliability " + folder());
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("trials.jsonl:2"));
  EXPECT_THAT(answer.err, HasSubstr("run the experiment again"));
}

}  // namespace
}  // namespace glocal::test::reliability_test
