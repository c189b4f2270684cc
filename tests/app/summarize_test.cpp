// glocal summarize.
#include <gmock/gmock.h>

#include "app/result_lines.hpp"
#include "app/room.hpp"

namespace glocal::test::summarize_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

Json right(int steps, double distance_m, double translation_m, double rotation_deg) {
  return {{"outcome", "right"},
          {"steps", steps},
          {"distance_m", distance_m},
          {"translation_error_m", translation_m},
          {"rotation_error_deg", rotation_deg}};
}

/// A step whose stages take so long together.
Json step(int trial, int number, double ms) {
  return {{"trial", trial},
          {"step", number},
          {"stage_ms", {{"local_map", 0.25}, {"match", ms - 1.0}, {"cluster", 0.5}, {"rate", 0.25}}}};
}

class SummarizeCommand : public Room {
 protected:
  /// a: right after 2 steps and after 1, one wrong, one failed. b: right after 1 step, one undecided.
  SummarizeCommand() {
    good(run_room("runs/a"));
    fs::copy(file("runs/a"), file("runs/b"), fs::copy_options::recursive);
    replace_lines(file("runs/a"),
                  {right(2, 1.0, 0.02, 0.2),
                   right(1, 3.0, 0.04, 0.4),
                   {{"outcome", "wrong"}, {"steps", 1}},
                   {{"outcome", "failed"}}},
                  {step(0, 0, 10.0), step(0, 1, 20.0), step(1, 0, 30.0), step(2, 0, 70.0)});
    replace_lines(file("runs/b"), {right(1, 9.0, 0.3, 3.0), {{"outcome", "undecided"}, {"steps", 1}}},
                  {step(0, 0, 40.0), step(1, 0, 60.0)});
  }

  [[nodiscard]] Json summary(const std::string& arguments) const {
    const Answer answer = good(run("summarize --json " + arguments));
    return Json::parse(answer.out);
  }
};

TEST_F(SummarizeCommand, HasARowForEachFolder) {
  const Answer answer = good(run("summarize runs"));
  EXPECT_EQ(answer.err, "");
  // Wilson, 95 %: 1 of 4 is 4.6 to 69.9 %, 0 of 2 is 0 to 65.8 %.
  EXPECT_EQ(
      answer.out,
      "| run | starts | right | wrong | undecided | wrong (95 % interval) | steps, way to localize "
      "(median) | error then (median) | a step (median) |\n"
      "|---|---|---|---|---|---|---|---|---|\n"
      "| a | 4 | 2 | 1 | 0, 1 failed | 25.0 % (4.6 to 69.9 %) | 1.5, 2.0 m | 3.0 cm, 0.30° | 25.0 ms |\n"
      "| b | 2 | 1 | 0 | 1 | 0.0 % (0.0 to 65.8 %) | 1, 9.0 m | 30.0 cm, 3.00° | 50.0 ms |\n");
}

TEST_F(SummarizeCommand, PoolsTrialsNotMedians) {
  const Answer answer =
      good(run("summarize --pool --no-head --name both " + file("runs/a") + " " + file("runs/b")));
  // Of 1, 3 and 9 m; 2, 4 and 30 cm; 10, 20, 30, 40, 60 and 70 ms. 1 of 6 wrong.
  EXPECT_EQ(
      answer.out,
      "| both | 6 | 3 | 1 | 1, 1 failed | 16.7 % (3.0 to 56.4 %) | 1, 3.0 m | 4.0 cm, 0.40° | 35.0 ms |\n");
  const Json pooled = summary("--pool " + file("runs"));
  ASSERT_EQ(pooled.size(), 1U);
  EXPECT_EQ(pooled[0]["name"], "all");
  EXPECT_EQ(pooled[0]["folders"], Json::array({file("runs/a"), file("runs/b")}));
  EXPECT_EQ(pooled[0]["trials"],
            Json::parse(R"({"count": 6, "right": 3, "wrong": 1, "undecided": 1, "failed": 1})"));
  EXPECT_NEAR(pooled[0]["false_rate"]["high"].get<double>(), 0.5635, 1e-3);
  EXPECT_EQ(pooled[0]["steps"], 6);
}

TEST_F(SummarizeCommand, LooksAtSomeStepsOnly) {
  EXPECT_EQ(summary("--steps 1:9 runs/a")[0]["step_ms"]["median"], 20.0);
  EXPECT_EQ(summary("--steps 0:1 runs/a")[0]["step_ms"]["median"], 30.0);
  EXPECT_FALSE(summary("--steps 7:9 runs/a")[0].contains("step_ms"));
  EXPECT_THAT(run("summarize --no-head --steps 7:9 runs/a").out, EndsWith("| – |\n"));
  for (const char* wrong : {"5", "5:", ":5", "5:5", "7:5", "a:b", "1:2:3"}) {
    const Answer answer = run("summarize --steps " + std::string(wrong) + " runs/a");
    EXPECT_EQ(answer.exit_code, 2) << wrong;
    EXPECT_THAT(answer.err, HasSubstr("is no range of steps")) << wrong;
  }
}

TEST_F(SummarizeCommand, SaysWhatTheRunItselfSays) {
  write_experiment("trials: {every_scan: 2, max_steps: 8}\n", "output: {maps: none}\n");
  good(run_room("c"));
  const Json own = json("c/summary.json");
  ASSERT_GT(own["trials"]["right"], 0);
  const Json told = summary("c")[0];
  for (const auto& [key, value] : told.items()) {
    if (key == "name" || key == "folders") continue;
    if (key == "rotation_error_deg" || key == "after_declaration") continue;
    EXPECT_EQ(value, own[key]) << key;
  }
  // Degrees that went to radians and back.
  for (const char* share : {"median", "max"}) {
    EXPECT_NEAR(told["rotation_error_deg"][share].get<double>(),
                own["rotation_error_deg"][share].get<double>(), 1e-9);
  }
  EXPECT_EQ(told["after_declaration"]["steps"], own["after_declaration"]["steps"]);
  EXPECT_EQ(told["after_declaration"]["translation_error_m"],
            own["after_declaration"]["translation_error_m"]);
}

TEST_F(SummarizeCommand, LeavesOutWhatIsNotKnown) {
  // Nothing is declared in a single step.
  good(run_room("none", "--quiet --set output.steps=false --set trials.max_steps=1"));
  const Answer answer = run("summarize --no-head none");
  EXPECT_THAT(answer.out, AllOf(StartsWith("| none |"), EndsWith("| – | – | – |\n")));
  const Json row = summary("none")[0];
  EXPECT_FALSE(row.contains("step_ms"));
  EXPECT_TRUE(row.contains("success_rate"));
  // Without any reference none is wrong, whatever was declared.
  replace_lines("none", {{{"outcome", "declared"}}, {{"outcome", "undecided"}}}, {});
  EXPECT_EQ(run("summarize --no-head none").out, "| none | 2 | 0 | 0 | 1, 1 not judged | – | – | – | – |\n");
}

TEST_F(SummarizeCommand, RefusesWhatItCannotName) {
  EXPECT_THAT(refusal(run("summarize --name one runs")), HasSubstr("--name one: error: there are 2 rows"));
  EXPECT_THAT(run("summarize --name one --no-head runs/a").out, StartsWith("| one | 4 |"));
  EXPECT_THAT(run("summarize runs/a runs").err, HasSubstr("is named twice"));
}

}  // namespace
}  // namespace glocal::test::summarize_test
