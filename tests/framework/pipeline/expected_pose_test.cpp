// Where a robot is thought to be before anything was seen.
#include <gmock/gmock.h>

#include "framework/pipeline/fakes.hpp"
#include "glocal/localizer.hpp"

namespace glocal::test::expected_pose_test {
namespace {

using testing::Contains;
using testing::Not;

/// The map is one point at the origin, and so is the local map: the pose 0 has all contact, others have none.
class Expected : public testing::Test {
 protected:
  Expected() : localizer_(follow(script_), registered(catalog_), {map_of_one_point(), 1}, 1) {
    script_->local.points.push_back({});
    script_->local.ends = {1};
    find(elsewhere_, 0.9);
  }

  static const Catalog& registered(Catalog& catalog) {
    register_fake_stages(catalog);
    return catalog;
  }

  /// What the matcher finds by itself.
  void find(const Pose3& pose, double score) {
    script_->r = {0.6, 0.4};
    const Hypothesis found{.map_from_local = pose, .quality = score, .score = score};
    script_->match = [=](double, Rng&) { return MatchResult{{found}, 1, 1}; };
  }

  const Pose3 elsewhere_ = Pose2{9.0, 9.0, 0.0};
  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  Catalog catalog_;
  Localizer localizer_;
};

TEST_F(Expected, IsOneMoreCandidateOfTheFirstStep) {
  localizer_.expect({Pose3{}, 9.0});
  const StepResult first = localizer_.step({});
  ASSERT_EQ(first.hypotheses.size(), 2U);
  EXPECT_EQ(first.hypotheses[0].map_from_robot, Pose3{}) << "it has more contact";
  EXPECT_EQ(first.hypotheses[0].score, 1.0);
  EXPECT_EQ(first.hypotheses[1].map_from_robot, elsewhere_);
  EXPECT_EQ(first.score_best, 1.0);
  ASSERT_TRUE(first.expected);
  EXPECT_EQ(first.expected->map_from_robot, Pose3{});
  EXPECT_EQ(first.expected->odds, 9.0);
  EXPECT_THAT(script_->calls, Contains("rescore"));
  script_->r = {1.0};
  script_->calls.clear();
  EXPECT_EQ(localizer_.step({}).hypotheses.size(), 1U) << "the matcher carries it on, or not";
  EXPECT_THAT(script_->calls, Not(Contains("rescore")));
}

TEST_F(Expected, MovesWithTheRobot) {
  find(Pose3{}, 1.0);
  script_->r = {0.5, 0.5};
  localizer_.expect({Pose3{}, 9.0});
  EXPECT_TRUE(localizer_.step({}).expected);
  script_->local.local_from_robot = Pose2{1.0, 2.0, 0.5};
  script_->r = {1.0};
  const StepResult next = localizer_.step({});
  ASSERT_TRUE(next.expected);
  EXPECT_EQ(next.expected->map_from_robot, Pose3(Pose2{1.0, 2.0, 0.5}));
}

TEST_F(Expected, WaitsUntilSomethingIsSeen) {
  script_->match = [](double, Rng&) { return MatchResult{}; };
  const Points seen = std::exchange(script_->local.points, {});
  const std::vector<std::size_t> ends = std::exchange(script_->local.ends, {});
  localizer_.expect({Pose3{}, 9.0});
  script_->r = {};
  EXPECT_FALSE(localizer_.step({}).expected);
  EXPECT_THAT(script_->calls, Not(Contains("rescore")));
  script_->local.points = seen;
  script_->local.ends = ends;
  script_->local.local_from_robot = Pose2{1.0, 0.0, 0.0};
  script_->r = {1.0};
  const StepResult second = localizer_.step({});
  ASSERT_TRUE(second.expected);
  EXPECT_EQ(second.expected->map_from_robot, Pose3(Pose2{1.0, 0.0, 0.0}));
}

TEST_F(Expected, IsDroppedOnceAnotherPoseIsBetter) {
  localizer_.expect({Pose2{1.0, 0.0, 0.0}, 9.0});  // Out of contact there, and below the threshold.
  script_->r = {1.0};
  const StepResult first = localizer_.step({});
  EXPECT_FALSE(first.expected);
  EXPECT_EQ(first.hypotheses.size(), 1U);
  find(Pose2{1.0, 0.0, 0.0}, 0.9);
  script_->r = {1.0};
  EXPECT_FALSE(localizer_.step({}).expected) << "for good";
}

TEST_F(Expected, IsDroppedWhereTheLocalFrameChangesAndForgottenByReset) {
  find(Pose3{}, 1.0);
  script_->r = {0.5, 0.5};
  localizer_.expect({Pose3{}, 9.0});
  EXPECT_TRUE(localizer_.step({}).expected);
  script_->local.epoch = 1;
  script_->r = {1.0};
  EXPECT_FALSE(localizer_.step({}).expected);
  localizer_.expect({Pose3{}, 9.0});
  localizer_.reset(1);
  EXPECT_FALSE(localizer_.step({}).expected);
}

}  // namespace
}  // namespace glocal::test::expected_pose_test
