#include "raters/staged_margin.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "raters/kinds.hpp"

namespace glocal::raters::staged_margin_test {
namespace {

using enum VerdictKind;
using test::kinds;
using testing::ElementsAre;

const Pose2 here{3.0, 4.0, 0.5};
const Pose2 there{8.0, 1.0, 2.0};

/// A step with the best pose `here` and a rival, after a drive of `driven` metres straight on.
StepResult step(double best, double rival, double driven = 0.0, int epoch = 0) {
  StepResult result;
  result.omega_max = 0.1;
  result.local_from_robot = Pose2{driven, 0.0, 0.0};
  result.local_map_epoch = epoch;
  const Pose2 ahead{driven, 0.0, 0.0};
  result.hypotheses.push_back({.map_from_local = here, .map_from_robot = here * ahead, .score = best});
  result.hypotheses.push_back({.map_from_local = there, .map_from_robot = there * ahead, .score = rival});
  return result;
}

TEST(StagedMargin, AClearLeadIsEnoughAfterThreeSteps) {
  StagedMargin rule({}, {});
  EXPECT_THAT(kinds(rule, std::vector(2, step(0.9, 0.55))), ElementsAre(searching, searching));
  const Verdict verdict = rule.judge(step(0.9, 0.55));
  EXPECT_EQ(verdict.kind, localized);
  EXPECT_EQ(verdict.map_from_robot, here);
}

TEST(StagedMargin, ASmallerLeadMustLastLongerAndOverSomeWay) {
  // 0.22 needs 5 steps and 2 m.
  for (const double each : {0.3, 0.6}) {
    StagedMargin rule({}, {});
    int declared_in = 0;
    for (int i = 1; i <= 10 && declared_in == 0; ++i) {
      if (rule.judge(step(0.9, 0.68, each * i)).kind == localized) declared_in = i;
    }
    // The way counts from the first step with the margin: seven times 0.3 m, or four times 0.6 m.
    EXPECT_EQ(declared_in, each < 0.5 ? 8 : 5) << each;
  }
}

TEST(StagedMargin, OneStepWithoutTheLeadBeginsAnew) {
  StagedMargin rule({}, {});
  const StepResult clear = step(0.9, 0.5);
  EXPECT_THAT(kinds(rule, {clear, clear, step(0.9, 0.7), clear, clear, clear}),
              ElementsAre(searching, searching, searching, searching, searching, localized));
}

TEST(StagedMargin, ScansWithoutAPointCountNothing) {
  const auto without_points = [](double driven) {
    StepResult result = step(0.9, 0.3, driven);
    result.saw_nothing = true;
    result.omega_scan = 0.0;  // One stray hit.
    return result;
  };
  StagedMargin rule({}, {});
  (void)rule.judge(step(0.9, 0.3));
  for (int i = 1; i <= 20; ++i) EXPECT_EQ(rule.judge(without_points(0.5 * i)).kind, searching) << i;
  // Looks count on, and what is declared stays so.
  EXPECT_THAT(kinds(rule, {step(0.9, 0.3, 10.5), step(0.9, 0.3, 11.0), without_points(11.5)}),
              ElementsAre(searching, localized, localized));
}

TEST(StagedMargin, AScanThatDoesNotFitBeginsAnewAndTakesTheVerdictBack) {
  StagedMargin rule({}, {});
  const auto with_scan = [](double contact) {
    StepResult result = step(0.9, 0.5);
    result.omega_scan = contact;
    return result;
  };
  EXPECT_THAT(kinds(rule, {with_scan(0.95), with_scan(0.95), with_scan(0.95), with_scan(0.76)}),
              ElementsAre(searching, searching, localized, localized));
  const Verdict verdict = rule.judge(with_scan(0.7));
  EXPECT_EQ(verdict.kind, searching);
  EXPECT_EQ(verdict.why, "only 70 % of the last scan fits the best pose");
  EXPECT_THAT(kinds(rule, std::vector(3, with_scan(0.95))), ElementsAre(searching, searching, localized));
}

TEST(StagedMargin, AnotherBestPoseBeginsAnewAndTakesTheVerdictBack) {
  StagedMargin rule({}, {});
  for (int i = 0; i < 5; ++i) (void)rule.judge(step(0.9, 0.5));
  StepResult other = step(0.9, 0.5);
  std::swap(other.hypotheses[0].map_from_robot, other.hypotheses[1].map_from_robot);
  EXPECT_THAT(kinds(rule, std::vector(3, other)), ElementsAre(searching, searching, localized));
}

TEST(StagedMargin, AnotherLocalFrameOrAStepWithoutHypothesesBeginsAnew) {
  const StepResult clear = step(0.9, 0.5);
  StagedMargin with_gap({}, {});
  EXPECT_THAT(kinds(with_gap, {clear, clear, clear, {}, clear}),
              ElementsAre(searching, searching, localized, searching, searching));
  StagedMargin in_another_frame({}, {});
  EXPECT_THAT(kinds(in_another_frame, {clear, clear, clear, step(0.9, 0.5, 0.0, 1)}),
              ElementsAre(searching, searching, localized, searching));
}

TEST(StagedMargin, PosesNearTheBestAreNoRivals) {
  StagedMargin rule({}, {});
  StepResult near = step(0.9, 0.88);
  near.hypotheses[1].map_from_robot = here * Pose2{0.5, 0.0, radians(20.0)};
  // The only rivals can be below Omega_max: a margin of 0.8.
  for (int i = 0; i < 2; ++i) (void)rule.judge(near);
  EXPECT_EQ(rule.judge(near).kind, localized);
  // Turned by more than 30 degrees, it is one.
  rule.reset();
  near.hypotheses[1].map_from_robot = here * Pose2{0.5, 0.0, radians(40.0)};
  EXPECT_EQ(rule.judge(near).kind, ambiguous);
}

TEST(StagedMargin, RivalsOfTheSameQualityAreCandidates) {
  StagedMargin rule({}, {});
  const Verdict verdict = rule.judge(step(0.9, 0.87));
  EXPECT_EQ(verdict.kind, ambiguous);
  ASSERT_EQ(verdict.candidates.size(), 2U);
  EXPECT_EQ(verdict.candidates[0], here);
  EXPECT_EQ(verdict.candidates[1], there);
  EXPECT_EQ(rule.judge(step(0.9, 0.79)).kind, searching);
}

TEST(StagedMargin, StaysDeclaredUntilTheLeadIsBelowEveryStages) {
  StagedMargin rule({}, {});
  const StepResult clear = step(0.9, 0.5);
  EXPECT_THAT(kinds(rule, {clear, clear, clear, step(0.9, 0.78), step(0.9, 0.82), step(0.9, 0.78)}),
              ElementsAre(searching, searching, localized, localized, ambiguous, searching));
}

TEST(StagedMargin, ARobotThatTurnsFastIsNotDeclaredUntilSomeStepsLater) {
  StagedMargin rule({}, {});
  std::vector<StepResult> steps;
  // 70 degrees a second up to step 3; then it stands.
  for (int i = 0; i < 7; ++i) {
    StepResult turning = step(0.9, 0.5);
    const Pose2 turned{0.0, 0.0, radians(70.0 * std::min(i, 3))};
    turning.stamp = i;
    turning.local_from_robot = turned;
    turning.hypotheses[0].map_from_robot = here * turned;
    turning.hypotheses[1].map_from_robot = there * turned;
    steps.push_back(turning);
  }
  EXPECT_THAT(kinds(rule, steps),
              ElementsAre(searching, searching, searching, searching, searching, searching, localized));
}

TEST(StagedMargin, AFastTurnIsSeenWhereStampsAreWholeSeconds) {
  StagedMargin rule({}, {});
  // 80 degrees a second, ten steps in each. In the first one nothing is clear.
  for (int i = 0; i < 30; ++i) {
    StepResult turning = step(0.9, i < 10 ? 0.88 : 0.3);
    const Pose2 turned{0.0, 0.0, radians(8.0 * i)};
    turning.stamp = i / 10;
    turning.local_from_robot = turned;
    for (Hypothesis& h : turning.hypotheses) h.map_from_robot = h.map_from_robot * Pose3(turned);
    EXPECT_NE(rule.judge(turning).kind, localized) << i;
  }
}

TEST(StagedMargin, ATurnIsSeenInAStepWithoutHypothesesToo) {
  StagedMargin rule({}, {});
  std::vector<StepResult> steps;
  // 70 degrees in step 1, which nothing fits.
  for (int i = 0; i < 6; ++i) {
    StepResult after = step(0.9, 0.5);
    const Pose2 turned{0.0, 0.0, radians(i > 0 ? 70.0 : 0.0)};
    after.stamp = i;
    after.local_from_robot = turned;
    for (Hypothesis& h : after.hypotheses) h.map_from_robot = h.map_from_robot * Pose3(turned);
    if (i == 1) after.hypotheses.clear();
    steps.push_back(after);
  }
  EXPECT_THAT(kinds(rule, steps),
              ElementsAre(searching, searching, searching, searching, localized, localized));
  // Step 4 is the third one that fits, and the third one after the turn.
  steps[1].local_from_robot = steps[2].local_from_robot = Pose2{0.0, 0.0, radians(70.0)};
  steps[2].hypotheses.clear();
  steps[3].stamp = 2.0;
  rule.reset();
  EXPECT_EQ(kinds(rule, steps)[4], searching);
}

TEST(StagedMargin, WhatIsWithheldIsDeclaredOnlyWhereAStageIsReached) {
  StagedMargin rule({}, {});
  const StepResult clear = step(0.9, 0.5);
  EXPECT_THAT(kinds(rule, {clear, clear, clear}), ElementsAre(searching, searching, localized));
  rule.withhold();
  // As clear as it takes to stay declared.
  EXPECT_EQ(rule.judge(step(0.9, 0.78)).kind, searching);
}

TEST(StagedMargin, AViolationOfFreeSpaceForbidsADeclaration) {
  StagedMargin rule({.max_free_space_violation = 0.4}, {});
  StepResult violating = step(0.9, 0.5);
  violating.hypotheses.front().free_space_violation = 0.41;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(rule.judge(violating).kind, searching) << i;
  violating.hypotheses.front().free_space_violation = 0.39;
  EXPECT_EQ(rule.judge(violating).kind, localized);
}

TEST(StagedMargin, ConfidenceIsTheLogisticModelOfLeadAndSteps) {
  StagedMargin rule({}, {});
  Verdict verdict = rule.judge(step(0.9, 0.7));
  ASSERT_TRUE(verdict.estimate);
  EXPECT_EQ(verdict.estimate->map_from_robot, here);
  // Log odds -1.5 + 28.5 * 0.2 = 4.2, then 4.2 + 0.45 ln 2.
  EXPECT_NEAR(verdict.estimate->confidence, 0.998 * 0.9852260, 1e-6);
  // A robot that stands sees the same again.
  verdict = rule.judge(step(0.9, 0.7, 0.04));
  EXPECT_NEAR(verdict.estimate->confidence, 0.998 * 0.9852260, 1e-6);
  verdict = rule.judge(step(0.9, 0.7, 0.06));
  EXPECT_NEAR(verdict.estimate->confidence, 0.998 * 0.9891412, 1e-6);
  EXPECT_EQ(rule.judge({}).estimate, std::nullopt);
}

/// A step that only a confidence can declare: little of its scan is on the map, and much of it is in free
/// space. Log odds of the second one: -2.74 + 31.93 * 0.2 + 1.204 * 0.7 ln 2 + 0.713 * 6.
StepResult cluttered(double driven, double omega_scan = 0.5) {
  StepResult result = step(0.5, 0.3, driven);
  result.omega_scan = omega_scan;
  result.hypotheses[0].quality = 0.7;
  result.hypotheses[0].free_space_violation = 0.6;
  result.hypotheses[0].beam_evidence = 7.5;
  result.hypotheses[1].beam_evidence = 1.5;
  return result;
}

StageSetup with_verifier() {
  StageSetup setup;
  setup.has_verifier = true;
  return setup;
}

TEST(StagedMargin, WhatBeamsSayMakesAConfidenceThatIsEnough) {
  StagedMargin rule({.min_confidence = 0.9975}, with_verifier());
  EXPECT_EQ(rule.judge(cluttered(0.0)).kind, searching);
  EXPECT_EQ(rule.judge(cluttered(0.0)).kind, searching);  // It stands.
  const Verdict verdict = rule.judge(cluttered(0.1));
  EXPECT_EQ(verdict.kind, localized);
  EXPECT_FALSE(verdict.needs_certificate);
  EXPECT_NEAR(verdict.estimate->confidence, 0.998 * 0.9997982, 1e-6);

  StagedMargin surer({.min_confidence = 0.9979}, with_verifier());
  StagedMargin unverified({.min_confidence = 0.9975}, {});
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(surer.judge(cluttered(0.1 * i)).kind, searching) << i;
    EXPECT_EQ(unverified.judge(cluttered(0.1 * i)).kind, searching) << i;
  }
}

TEST(StagedMargin, AMarginThatJumpsIsNotYetBelieved) {
  StagedMargin rule({}, with_verifier());
  const auto confidence = [&](double margin) {
    StepResult result = step(0.5, 0.5 - margin);
    for (Hypothesis& h : result.hypotheses) h.beam_evidence = 1.0;
    return rule.judge(result).estimate->confidence;
  };
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(confidence(0.1), 0.998 * 0.6113523, 1e-6) << i;
  // Mean margins of 0.12, then of 0.12 + (0.3 - 0.12) / 10.
  EXPECT_NEAR(confidence(0.3), 0.998 * 0.7486829, 1e-6);
  EXPECT_NEAR(confidence(0.3), 0.998 * 0.8410872, 1e-6);
}

TEST(StagedMargin, ARobotThatTurnsOnTheSpotSeesTheSameAgain) {
  StagedMargin rule({}, with_verifier());
  for (int i = 0; i < 5; ++i) {
    StepResult turned = cluttered(0.0);
    turned.local_from_robot = Pose2{0.0, 0.0, 0.3 * i};
    for (Hypothesis& h : turned.hypotheses) h.map_from_robot = h.map_from_local * turned.local_from_robot;
    EXPECT_EQ(rule.judge(turned).kind, searching) << i;
  }
}

TEST(StagedMargin, WhereTheRobotWasExpectedItIsSurer) {
  const auto confidence = [](const std::optional<ExpectedPose>& expected, double scan_contact = 0.95) {
    StagedMargin rule({}, with_verifier());
    StepResult result = cluttered(0.0, scan_contact);
    result.expected = expected;
    return rule.judge(result).estimate->confidence;
  };
  const double seen = confidence({}) / 0.998;
  EXPECT_NEAR(confidence(ExpectedPose{here, 19.0}), 0.998 * 19.0 * seen / (1.0 - seen + 19.0 * seen), 1e-9);
  EXPECT_DOUBLE_EQ(confidence(ExpectedPose{here, 1.0}), 0.998 * seen);
  EXPECT_DOUBLE_EQ(confidence(ExpectedPose{there, 19.0}), 0.998 * seen) << "that is another pose";
  EXPECT_DOUBLE_EQ(confidence(ExpectedPose{here, 19.0}, 0.85), 0.998 * seen) << "perhaps another floor";
}

TEST(StagedMargin, WithoutARivalBeamsSayNothing) {
  StagedMargin rule({}, with_verifier());
  StepResult alone = cluttered(0.0);
  alone.hypotheses.pop_back();
  const Verdict verdict = rule.judge(alone);
  // Log odds -2.74 + 31.93 * (0.5 - 0.1).
  EXPECT_NEAR(verdict.estimate->confidence, 0.998 * 0.9999560, 1e-6);
}

TEST(StagedMargin, AScanWithMuchLessContactThanUsualBeginsAnew) {
  StagedMargin rule({}, with_verifier());
  for (int i = 0; i < 3; ++i) (void)rule.judge(cluttered(0.1 * i));
  EXPECT_EQ(rule.judge(cluttered(0.3, 0.36)).kind, localized);  // 0.7 * 0.5 and a little more
  EXPECT_EQ(rule.judge(cluttered(0.4, 0.32)).kind, searching);
}

TEST(StagedMargin, ARefutedConfidenceMustLastTwiceAsLong) {
  StagedMargin rule({}, with_verifier());
  double driven = 0.0;
  const auto go_on = [&] { return rule.judge(cluttered(driven += 0.1)).kind; };
  (void)go_on();
  ASSERT_EQ(go_on(), localized);
  rule.refute({});
  for (int i = 1; i < 4; ++i) EXPECT_EQ(go_on(), searching) << i;
  EXPECT_EQ(go_on(), localized);
  // However often it was refuted, it can be sure again.
  for (int i = 0; i < 100; ++i) rule.refute({});
  EXPECT_EQ(go_on(), searching);
  for (int i = 1; i < 1023; ++i) (void)go_on();
  EXPECT_EQ(go_on(), localized);
}

TEST(StagedMargin, HypothesesNearTheBestWidenItsCovariance) {
  const PoseCovariance own{.xx = 0.01, .yy = 0.04, .tt = 0.001};
  StagedMargin rule({}, {});
  StepResult one = step(0.9, 0.2);
  one.hypotheses[0].covariance = own;
  EXPECT_EQ(rule.judge(one).estimate->covariance, own);
  // A second one of the same score, 0.2 m to the left in the map's y and turned by 0.1: half the weight.
  one.hypotheses.insert(one.hypotheses.begin() + 1, one.hypotheses[0]);
  one.hypotheses[1].map_from_robot = Pose2{here.x, here.y + 0.2, here.theta + 0.1};
  const auto wide = rule.judge(one).estimate->covariance;
  ASSERT_TRUE(wide);
  EXPECT_NEAR(wide->xx, 0.01, 1e-12);
  EXPECT_NEAR(wide->yy, 0.04 + 0.5 * 0.04, 1e-12);
  EXPECT_NEAR(wide->yt, 0.5 * 0.02, 1e-12);
  EXPECT_NEAR(wide->tt, 0.001 + 0.5 * 0.01, 1e-12);
}

/// What a verifier says that found a rival with this score, of a pose that has 0.9.
Verification with_rival(double score) {
  Verification verification;
  verification.margin = 0.05;
  verification.score = 0.9;
  verification.rivals.push_back(Hypothesis::by_contact(there, score));
  verification.certificate = {.contact = 0.9, .at_most = 0.95};
  return verification;
}

TEST(StagedMargin, LowerStagesNeedACertificateAndSomeoneWhoGivesIt) {
  StagedMargin alone({}, {});
  StagedMargin rule({}, with_verifier());
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(alone.judge(step(0.9, 0.65)).kind, searching);
    const Verdict verdict = rule.judge(step(0.9, 0.65));
    EXPECT_EQ(verdict.kind, i < 1 ? searching : localized);
    EXPECT_EQ(verdict.needs_certificate, i == 1);
  }
  // A lead that lasts long enough by itself does not.
  StagedMargin clear({}, with_verifier());
  for (int i = 0; i < 2; ++i) (void)clear.judge(step(0.9, 0.5));
  EXPECT_FALSE(clear.judge(step(0.9, 0.5)).needs_certificate);
}

TEST(StagedMargin, WithoutCertificateTheLeadGoesOnCounting) {
  // 0.35 is enough by itself after three steps, and with a certificate after two.
  StagedMargin rule({}, with_verifier());
  (void)rule.judge(step(0.9, 0.55));
  EXPECT_EQ(rule.judge(step(0.9, 0.55)).kind, localized);
  rule.refute(with_rival(0.5));
  const Verdict third = rule.judge(step(0.9, 0.55));
  EXPECT_EQ(third.kind, localized);
  EXPECT_FALSE(third.needs_certificate);
}

TEST(StagedMargin, ARivalThatWasNotKnownBeginsAnew) {
  StagedMargin rule({}, with_verifier());
  (void)rule.judge(step(0.9, 0.55));
  (void)rule.judge(step(0.9, 0.55));
  rule.refute(with_rival(0.88));
  EXPECT_EQ(rule.judge(step(0.9, 0.55)).kind, searching);
  EXPECT_TRUE(rule.judge(step(0.9, 0.55)).needs_certificate);
}

TEST(StagedMargin, KnowsWhenItCanDeclareAtTheEarliest) {
  EXPECT_EQ(StagedMargin({}, {}).least_steps(), 3U);
  EXPECT_EQ(StagedMargin({}, with_verifier()).least_steps(), 2U);
  // By its confidence.
  const std::vector<StagedMargin::Stage> late = {{.margin = 0.3, .steps = 30}};
  EXPECT_EQ(StagedMargin({.stages = late, .certified_stages = {}}, with_verifier()).least_steps(), 2U);
  EXPECT_EQ(StagedMargin({.stages = late}, {}).least_steps(), 30U);
}

}  // namespace
}  // namespace glocal::raters::staged_margin_test
