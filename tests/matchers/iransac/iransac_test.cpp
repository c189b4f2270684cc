#include "matchers/iransac/iransac.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "matchers/same_answer.hpp"
#include "test_world.hpp"

namespace glocal::iransac::iransac_test {
namespace {

using test::local_map_at;

class IRansacWithOrWithoutHashing : public ::testing::TestWithParam<bool> {
 protected:
  static IRansac::Params params() { return {.lsh = GetParam()}; }
};

bool is_right(const MatchResult& result, const Pose2& truth) {
  if (result.hypotheses.empty()) return false;
  const Pose3& best = result.hypotheses.front().map_from_local;
  return distance(best, truth) < 0.05 && rotation_between(best, truth) < radians(1.0);
}

TEST_P(IRansacWithOrWithoutHashing, FindsThePose) {
  IRansac matcher(params(), {test::small_world(), 1});
  Rng rng(3);
  int right = 0;
  constexpr int places = 10;
  for (int i = 0; i < places; ++i) {
    const Pose2 truth = test::somewhere_in_small_world(i, rng);
    matcher.reset();
    right += is_right(matcher.match({local_map_at(truth, 5.0), {}, 0.5}, rng), truth) ? 1 : 0;
  }
  EXPECT_GE(right, places - 1);
}

TEST_P(IRansacWithOrWithoutHashing, AnswersAlikeForAnyNumberOfThreads) {
  IRansac one(params(), {test::small_world(), 1});
  IRansac two(params(), {test::small_world(), 2});
  Rng rng_of_one(1);
  Rng rng_of_two(1);
  for (const double reach : {3.0, 4.0, 5.0}) {
    const LocalMap local = local_map_at({5.5, 2.5, 0.7}, reach);
    test::expect_same_answer(one.match({local, {}, 0.2}, rng_of_one),
                             two.match({local, {}, 0.2}, rng_of_two));
  }
}

INSTANTIATE_TEST_SUITE_P(IRansac, IRansacWithOrWithoutHashing, ::testing::Bool());

/// Without fresh hypotheses, what a step finds can only be what was carried on from the one before.
class IRansacPool : public ::testing::Test {
 protected:
  /// A step that finds the pose, then one that draws nothing.
  MatchResult second_step(bool reset_between, int epoch) {
    IRansac matcher({}, {test::small_world(), 1});
    Rng rng(2);
    LocalMap local = local_map_at(truth_, 5.0);
    EXPECT_TRUE(is_right(matcher.match({local, {}, 0.5}, rng), truth_));
    if (reset_between) matcher.reset();
    local.epoch = epoch;
    local.local_from_robot = Pose2{0.3, 0.0, 0.1};  // the robot has moved on in its local map
    // Too few points for a feature, let alone two.
    Points few;
    for (std::size_t i = 0; i < 3; ++i) few.push_back(local.points[i * local.points.size() / 3]);
    local.points = few;
    local.ends = {few.size()};
    return matcher.match({local, {}, 0.5}, rng);
  }
  const Pose2 truth_{2.0, 2.5, 0.5};
};

TEST_F(IRansacPool, IsCarriedAlongByTheLocalMotion) {
  const MatchResult found = second_step(false, 0);
  EXPECT_EQ(found.proposals, 0U);
  ASSERT_FALSE(found.hypotheses.empty());
  EXPECT_TRUE(std::any_of(found.hypotheses.begin(), found.hypotheses.end(),
                          [&](const Hypothesis& h) { return distance(h.map_from_local, truth_) < 0.2; }));
}

TEST_F(IRansacPool, IsForgottenByAResetAndInANewFrame) {
  EXPECT_TRUE(second_step(true, 0).hypotheses.empty());
  EXPECT_TRUE(second_step(false, 1).hypotheses.empty());
}

TEST(IRansac, AnEmptyLocalMapFitsNowhere) {
  IRansac matcher({}, {test::small_world(), 1});
  Rng rng(1);
  EXPECT_TRUE(matcher.match({LocalMap{}, {}, 0.0}, rng).hypotheses.empty());
}

}  // namespace
}  // namespace glocal::iransac::iransac_test
