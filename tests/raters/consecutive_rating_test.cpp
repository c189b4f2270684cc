#include "raters/consecutive_rating.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raters/kinds.hpp"

namespace glocal::raters::consecutive_rating_test {
namespace {

using enum VerdictKind;
using test::kinds;
using testing::ElementsAre;

struct Rated {
  Pose2 pose;
  double r;
};

/// A step with clusters at these robot poses.
StepResult step(const std::vector<Rated>& rated, const Pose2& local_from_robot = {}, int epoch = 0) {
  StepResult result;
  result.local_from_robot = local_from_robot;
  result.local_map_epoch = epoch;
  double sum = 0.0;
  for (const Rated& one : rated) sum += one.r;
  for (const Rated& one : rated) {
    result.clusters.push_back({{0}, one.pose, 0, 0, 0});
    result.ratings.push_back({one.r, one.r / sum});
  }
  return result;
}

const Rated good{{3.0, 4.0, 0.5}, 0.9};
const Rated poor{{8.0, 1.0, 2.0}, 0.1};

TEST(ConsecutiveRating, LocalizedInTheThirdConsecutiveStep) {
  ConsecutiveRating rule({});
  EXPECT_THAT(kinds(rule, std::vector(2, step({good, poor}))), ElementsAre(searching, searching));
  const Verdict verdict = rule.judge(step({good, poor}));
  EXPECT_EQ(verdict.kind, localized);
  EXPECT_EQ(verdict.map_from_robot, good.pose);
  EXPECT_EQ(rule.judge(step({good, poor})).kind, localized);
}

TEST(ConsecutiveRating, ScansWithoutAPointCountNothing) {
  StepResult nothing = step({good, poor});
  nothing.saw_nothing = true;
  ConsecutiveRating rule({});
  EXPECT_THAT(kinds(rule, std::vector(5, nothing)), testing::Each(searching));
  const StepResult look = step({good, poor});
  EXPECT_THAT(kinds(rule, {look, nothing, look, nothing, look, nothing}),
              ElementsAre(searching, searching, searching, searching, localized, localized));
}

TEST(ConsecutiveRating, TheRatingMustBeLarger) {
  ConsecutiveRating rule({});
  for (int i = 0; i < 5; ++i) {
    EXPECT_NE(rule.judge(step({{good.pose, 0.8}, {poor.pose, 0.2}})).kind, localized);
  }
}

TEST(ConsecutiveRating, AStepWithoutClustersResetsTheCount) {
  ConsecutiveRating rule({});
  EXPECT_THAT(kinds(rule, std::vector(2, step({good}))), ElementsAre(searching, searching));
  const Verdict empty = rule.judge(step({}));
  EXPECT_EQ(empty.kind, searching);
  EXPECT_FALSE(empty.why.empty());
  EXPECT_THAT(kinds(rule, std::vector(3, step({good}))), ElementsAre(searching, searching, localized));
}

TEST(ConsecutiveRating, TheSameClusterMovesWithTheRobot) {
  // The robot drives 1 m a step, straight ahead: its pose in the map must do the same.
  const auto drive = [](double sideways) {
    ConsecutiveRating rule({});
    Verdict verdict;
    for (int i = 0; i < 3; ++i) {
      verdict = rule.judge(step({{{5.0 + sideways * i, 2.0 + i, radians(90)}, 0.9}}, {1.0 * i, 0.0, 0.0}));
    }
    return verdict.kind;
  };
  EXPECT_EQ(drive(0.0), localized);
  EXPECT_EQ(drive(0.4), localized);
  EXPECT_EQ(drive(0.6), searching);
}

TEST(ConsecutiveRating, ATurnedClusterIsAnother) {
  ConsecutiveRating rule({});
  const Rated turned{{3.0, 4.0, 0.5 + radians(20)}, 0.9};
  EXPECT_THAT(kinds(rule, {step({good}), step({good}), step({turned})}),
              ElementsAre(searching, searching, searching));
}

TEST(ConsecutiveRating, ANewLocalMapStartsOver) {
  ConsecutiveRating rule({});
  EXPECT_THAT(kinds(rule, {step({good}), step({good}), step({good}, {}, 1)}),
              ElementsAre(searching, searching, searching));
}

TEST(ConsecutiveRating, EquallyGoodPosesAreAmbiguous) {
  ConsecutiveRating rule({});
  const Rated other{{8.0, 1.0, 2.0}, 0.85};
  const Rated repeated{{3.1, 4.1, 0.55}, 0.8};  // the same place as the first
  const Rated weak{{1.0, 1.0, 1.0}, 0.3};
  const Verdict verdict = rule.judge(step({good, other, repeated, weak}));
  EXPECT_EQ(verdict.kind, ambiguous);
  EXPECT_THAT(verdict.candidates, ElementsAre(good.pose, other.pose));
}

TEST(ConsecutiveRating, HundredsOfPosesSayNothing) {
  ConsecutiveRating rule({});
  std::vector<Rated> rated;
  for (int i = 0; i < 300; ++i) rated.push_back({{1.0 * i, 0.0, 0.0}, 0.4});
  const Verdict verdict = rule.judge(step(rated));
  EXPECT_EQ(verdict.kind, searching);
  EXPECT_TRUE(verdict.candidates.empty());
}

TEST(ConsecutiveRating, ResetForgets) {
  ConsecutiveRating rule({});
  (void)rule.judge(step({good}));
  (void)rule.judge(step({good}));
  rule.reset();
  EXPECT_EQ(rule.judge(step({good})).kind, searching);
}

TEST(ConsecutiveRating, CountsPlacesForPeople) {
  ConsecutiveRating rule({});
  const auto why = [&](const std::vector<Rated>& rated) { return rule.judge(step(rated)).why; };
  // A metre and more apart, and half a metre.
  EXPECT_EQ(why({{{0, 0, 0}, 0.5}, {{5, 0, 0}, 0.5}}), "2 poses explain the observations about equally well");
  EXPECT_EQ(why({{{0, 0, 0}, 0.5}, {{0, 0, 3}, 0.5}, {{5, 0, 0}, 0.5}, {{5.5, 0, 1}, 0.5}}),
            "4 poses at 2 places explain the observations about equally well");
  EXPECT_EQ(why({{{0, 0, 0}, 0.5}, {{0, 0, 3}, 0.5}}),
            "2 poses at one place explain the observations about equally well");
}

TEST(ConsecutiveRating, NamesTheRatingThatItLooksAt) {
  ConsecutiveRating rule({});
  std::vector<Rated> many;
  for (int i = 0; i < 11; ++i) many.push_back({{5.0 * i, 0, 0}, 0.4});
  EXPECT_EQ(rule.judge(step(many)).why,
            "the best of 11 clusters has only r̄ = 0.09 of all ratings, and more than 0.80 is needed");
  many.pop_back();
  EXPECT_EQ(rule.judge(step(many)).kind, ambiguous);
}

TEST(ConsecutiveRating, KnowsWhenItCanDeclareAtTheEarliest) {
  EXPECT_EQ(ConsecutiveRating({.consecutive = 5}).least_steps(), 5U);
}

}  // namespace
}  // namespace glocal::raters::consecutive_rating_test
