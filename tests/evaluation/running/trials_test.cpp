// What becomes of a trial, with stages that follow a script.
#include "evaluation/running/trials.hpp"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "framework/pipeline/fakes.hpp"

namespace glocal::test::trials_test {
namespace {

constexpr std::size_t never = 1000;

/// A drive of ten samples, a metre apart, on a grid whose cells are free up to x = 5.5. The estimate is
/// (0.3, 0.4) off the reference, and turned by 5 degrees.
class TrialTest : public testing::Test {
 protected:
  TrialTest() {
    register_fake_stages(catalog_);
    for (int i = 0; i < 10; ++i) {
      Sample sample;
      sample.observation.stamp = 100.0 + i;
      sample.observation.odom_from_robot = Pose2{static_cast<double>(i), 0.0, 0.0};
      sample.map_from_robot = sample.observation.odom_from_robot;
      drive_.samples.push_back(sample);
      drive_.path_m.push_back(i);
    }
    experiment_.trials = {.every_m = 100.0, .starts_m = {}, .max_steps = 4};
    experiment_.localizer = follow(script_);
    declare_at(never);
  }

  /// From this sample on the verdict is localized.
  void declare_at(std::size_t sample) {
    script_->r = {1.0};
    script_->match = [this](double, Rng&) {
      const Pose3& local_from_robot = script_->local.local_from_robot;
      return MatchResult{
          {Hypothesis::by_contact(estimate(local_from_robot.x) * inverse(local_from_robot), 0.9)}, 1, 1};
    };
    script_->judge = [this, sample](const StepResult& step) {
      if (start_ + step.step < sample) return Verdict{VerdictKind::searching, std::nullopt, {}, "not yet"};
      return Verdict{VerdictKind::localized, step.clusters.front().map_from_robot, {}, "found"};
    };
  }

  static Pose2 estimate(double x) { return {x + 0.3, 0.4, radians(5.0)}; }

  std::optional<TrialRecord> try_trial(std::size_t start, TrialCallbacks callbacks = {}) {
    start_ = start;
    script_->local.local_from_robot = Pose2{static_cast<double>(start), 0.0, 0.0};
    const auto given = callbacks.step;
    // The scripted mapper knows the robot's pose: a metre on with each step.
    callbacks.step = [this, given](const StepRecord& record, const Localizer& localizer) {
      script_->local.local_from_robot.x += 1.0;
      if (given) given(record, localizer);
    };
    MapData data;
    data.points.push_back({});
    data.grid = {{-0.5, -0.5, 0.0}, 1.0, 6, 1, PackedCells(6, Cell::free)};
    const auto map = std::make_shared<const GlobalMap>(std::move(data));
    Localizer localizer(experiment_.localizer, catalog_, {map, 1}, experiment_.seed);
    return run_trial(localizer, drive_, *map, experiment_, 7, start, callbacks);
  }

  TrialRecord run(std::size_t start) { return try_trial(start).value(); }

  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  Catalog catalog_;
  Drive drive_;
  Experiment experiment_;
  std::size_t start_ = 0;
};

TEST_F(TrialTest, ARightDeclarationEndsIt) {
  declare_at(4);
  const TrialRecord trial = run(2);
  EXPECT_EQ(trial.trial, 7U);
  EXPECT_EQ(trial.start_sample, 2U);
  EXPECT_EQ(trial.start_m, 2.0);
  EXPECT_EQ(trial.start_stamp, 102.0);
  EXPECT_EQ(trial.start_reference, (Pose2{2, 0, 0}));
  EXPECT_EQ(trial.outcome, Outcome::right);
  EXPECT_EQ(trial.steps, 3U);
  EXPECT_EQ(trial.records.size(), 3U);
  EXPECT_EQ(trial.distance_m, 2.0);
  ASSERT_TRUE(trial.pose);
  EXPECT_LT(distance(*trial.pose, estimate(4.0)), 1e-12);
  ASSERT_TRUE(trial.error);
  EXPECT_NEAR(trial.error->translation_m, 0.5, 1e-12);
  EXPECT_NEAR(degrees(trial.error->rotation_rad), 5.0, 1e-12);
  EXPECT_EQ(trial.why, "found");
}

TEST_F(TrialTest, EitherErrorMakesADeclarationWrong) {
  declare_at(0);
  experiment_.evaluation = {.max_translation_error = 0.51, .max_rotation_error_deg = 5.1};
  EXPECT_EQ(run(0).outcome, Outcome::right);
  experiment_.evaluation = {.max_translation_error = 0.49, .max_rotation_error_deg = 5.1};
  EXPECT_EQ(run(0).outcome, Outcome::wrong);
  experiment_.evaluation = {.max_translation_error = 0.51, .max_rotation_error_deg = 4.9};
  EXPECT_EQ(run(0).outcome, Outcome::wrong);
}

TEST_F(TrialTest, WithoutADeclarationItEndsAtMaxSteps) {
  const TrialRecord trial = run(1);
  EXPECT_EQ(trial.outcome, Outcome::undecided);
  EXPECT_EQ(trial.steps, 4U);
  EXPECT_EQ(trial.records.size(), 4U);
  EXPECT_EQ(trial.distance_m, 3.0);
  EXPECT_EQ(trial.pose, std::nullopt);
  EXPECT_FALSE(trial.error);
  EXPECT_EQ(trial.why, "not yet");
}

TEST_F(TrialTest, ItEndsWithTheDriveAndWithItsSegment) {
  EXPECT_EQ(run(8).records.size(), 2U);
  experiment_.trials.max_steps = 0;
  EXPECT_EQ(run(0).records.size(), 10U);
  for (std::size_t i = 6; i < 10; ++i) drive_.samples[i].segment = 1;
  EXPECT_EQ(run(3).records.size(), 3U);
  experiment_.trials = {.starts_m = {}, .whole = true};
  EXPECT_EQ(run(0).records.size(), 6U);
}

TEST_F(TrialTest, AWholeDriveGoesOnAfterItsFirstDeclaration) {
  declare_at(5);
  experiment_.trials = {.starts_m = {}, .whole = true, .max_steps = 4};
  const TrialRecord trial = run(0);
  EXPECT_EQ(trial.outcome, Outcome::right);
  EXPECT_EQ(trial.steps, 6U);
  EXPECT_EQ(trial.distance_m, 5.0);
  ASSERT_TRUE(trial.pose);
  EXPECT_LT(distance(*trial.pose, estimate(5.0)), 1e-12);
  EXPECT_EQ(trial.records.size(), 10U);
}

TEST_F(TrialTest, WithoutAReferenceADeclarationIsJustDeclared) {
  declare_at(1);
  for (Sample& sample : drive_.samples) sample.map_from_robot.reset();
  const TrialRecord trial = run(0);
  EXPECT_EQ(trial.outcome, Outcome::declared);
  ASSERT_TRUE(trial.pose);
  EXPECT_LT(distance(*trial.pose, estimate(1.0)), 1e-12);
  EXPECT_FALSE(trial.error);
  EXPECT_EQ(trial.start_reference, std::nullopt);
  EXPECT_FALSE(trial.records[0].error);
  EXPECT_FALSE(trial.records[0].on_map);
}

TEST_F(TrialTest, EachStepKnowsItsErrorAndWhetherTheMapShowsItsPlace) {
  experiment_.trials.max_steps = 0;
  const TrialRecord trial = run(4);
  ASSERT_EQ(trial.records.size(), 6U);
  EXPECT_EQ(trial.records[1].reference, (Pose2{5, 0, 0}));
  EXPECT_TRUE(trial.records[1].on_map);
  EXPECT_FALSE(trial.records[2].on_map);
  ASSERT_TRUE(trial.records[2].error);
  EXPECT_NEAR(trial.records[2].error->translation_m, 0.5, 1e-12);
  EXPECT_EQ(trial.records[2].hypotheses, 1U);
  EXPECT_TRUE(trial.records[2].result.hypotheses.empty());
}

TEST_F(TrialTest, TextsOfStrategiesBecomeUtf8) {
  script_->judge = [](const StepResult& step) -> Verdict {
    if (step.step == 1) throw std::runtime_error("caf\xe9");
    return {VerdictKind::searching, std::nullopt, {}, "\xff searching", {}, {{"\xc3m", 1.0}}};
  };
  const TrialRecord trial = run(2);
  EXPECT_EQ(trial.outcome, Outcome::failed);
  EXPECT_EQ(trial.why, "verdict_rule 'fake' threw an exception in step 1: caf\ufffd");
  ASSERT_EQ(trial.records.size(), 1U);
  EXPECT_EQ(trial.records[0].result.verdict.why, "\ufffd searching");
  EXPECT_EQ(trial.records[0].result.verdict.evidence[0].name, "\ufffdm");
}

TEST_F(TrialTest, GivesUpWhenToldToStop) {
  int asked = 0;
  int steps = 0;
  const TrialCallbacks callbacks{[&](const StepRecord&, const Localizer&) { ++steps; },
                                 [&] { return ++asked == 3; }};
  EXPECT_FALSE(try_trial(0, callbacks).has_value());
  EXPECT_EQ(steps, 2);
}

TEST(Outcome, IsFoundByItsName) {
  const std::vector<std::pair<std::string, Outcome>> names = {{"right", Outcome::right},
                                                              {"wrong", Outcome::wrong},
                                                              {"undecided", Outcome::undecided},
                                                              {"declared", Outcome::declared},
                                                              {"failed", Outcome::failed}};
  for (const auto& [name, outcome] : names) {
    EXPECT_EQ(outcome_of(name), outcome);
    EXPECT_EQ(to_string(outcome), name);
  }
  EXPECT_THROW(static_cast<void>(outcome_of("Right")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(outcome_of("")), std::invalid_argument);
}

TEST(IsOnMap, LooksInTheFrameOfAMapFarAway) {
  MapData data;
  data.points.push_back({});
  data.grid = {{0.0, 0.0, 0.0}, 1.0, 2, 1, {Cell::free, Cell::unknown}};
  data.origin = {500'000.0, 4'000'000.0, 0.0};
  const GlobalMap map(std::move(data));
  EXPECT_TRUE(is_on_map(Pose2{500'000.5, 4'000'000.5, 0}, map));
  EXPECT_FALSE(is_on_map(Pose2{500'001.5, 4'000'000.5, 0}, map));
  EXPECT_FALSE(is_on_map(Pose2{0.5, 0.5, 0}, map));
}

TEST(PoseError, InSpaceIsDistanceAndAngle) {
  const PoseError error = pose_error(Pose3({2, 3, 6}, exponential({0.3, 0, 0})), Pose3());
  EXPECT_DOUBLE_EQ(error.translation_m, 7.0);
  EXPECT_NEAR(error.rotation_rad, 0.3, 1e-12);
}

TEST(PoseError, TurnsTheShorterWay) {
  const PoseError error = pose_error(Pose2{3, 4, radians(179)}, Pose2{0, 0, radians(-179)});
  EXPECT_DOUBLE_EQ(error.translation_m, 5.0);
  EXPECT_NEAR(degrees(error.rotation_rad), 2.0, 1e-9);
}

}  // namespace
}  // namespace glocal::test::trials_test
