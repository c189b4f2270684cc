#include "matchers/grid_search/branch_and_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "glocal/error.hpp"
#include "matchers/same_answer.hpp"
#include "points.hpp"
#include "test_world.hpp"

namespace glocal::grid_search::branch_and_bound_test {
namespace {

using test::local_map_at;
using test::map_of;

constexpr PoseRefinement on_the_grid{.iterations = 0};

MatchResult match(const BranchAndBound::Params& params, const LocalMap& local, double omega_max = 0.1,
                  std::shared_ptr<const GlobalMap> map = test::small_world(), int threads = 1) {
  BranchAndBound matcher(params, {std::move(map), threads});
  Rng rng(1);
  return matcher.match({local, {}, omega_max}, rng);
}

LocalMap local_of(Points points) {
  LocalMap local;
  local.ends = {points.size()};
  local.points = std::move(points);
  return local;
}

TEST(BranchAndBound, FindsThePoseFromAnywhere) {
  Rng rng(6);
  int first = 0;
  constexpr int places = 20;
  for (int i = 0; i < places; ++i) {
    const Pose2 truth = test::somewhere_in_small_world(i, rng);
    const MatchResult result = match({}, local_map_at(truth, 4.0));
    ASSERT_FALSE(result.hypotheses.empty());
    const Pose3& best = result.hypotheses.front().map_from_local;
    if (distance(best, truth) < 0.05 && rotation_between(best, truth) < radians(1.0)) ++first;
  }
  // The world looks like itself in places, seen from near by.
  EXPECT_GE(first, places - 1);
}

TEST(BranchAndBound, FindsAllPosesOfASymmetricWorld) {
  Points room;
  test::add_wall(room, {{0, 0}, {6, 0}, {6, 4}, {0, 4}, {0, 0}});
  const Pose2 truth{2.0, 1.5, 0.4};
  const Pose2 turned = Pose2{6.0, 4.0, radians(180.0)} * truth;
  const auto found = match({}, local_of(test::seen_from(room, truth, 9.0)), 0.9, map_of(room)).hypotheses;
  ASSERT_EQ(found.size(), 2U);
  for (const Pose2& expected : {truth, turned}) {
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const Hypothesis& h) {
      return distance(h.map_from_local, expected) < 0.05 &&
             rotation_between(h.map_from_local, expected) < 0.02;
    }));
  }
}

TEST(BranchAndBound, HypothesesAreDistinctAndUnrefinedOnesKeepTheQualityOfTheGrid) {
  const LocalMap local = local_map_at({2.0, 6.0, -1.0}, 2.5);
  const BranchAndBound::Params params{.grid = {.contact_epsilon = 0.1}, .refinement = on_the_grid};
  const auto found = match(params, local).hypotheses;
  ASSERT_GT(found.size(), 1U);
  // Half a diagonal of a cell nearer or farther than epsilon is all that the grid can be wrong by.
  const double blur = params.grid.cell / std::sqrt(2.0) + 1e-4;
  const auto near = contact_index(*test::small_world(), "kd_tree", *params.grid.contact_epsilon - blur);
  const auto far = contact_index(*test::small_world(), "kd_tree", *params.grid.contact_epsilon + blur);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Transform pose(seen_from_above(found[i].map_from_local));
    EXPECT_GE(found[i].score, near->share(local.points, pose));
    EXPECT_LE(found[i].score, far->share(local.points, pose));
    for (std::size_t k = 0; k < i; ++k) {
      const Pose3& a = found[i].map_from_local;
      const Pose3& b = found[k].map_from_local;
      EXPECT_TRUE(distance(a, b) >= candidate_distance || rotation_between(a, b) >= candidate_rotation);
    }
  }
}

TEST(BranchAndBound, RefinedOnesAreAsGoodAsAllPointsSay) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  const auto contact = contact_index(*test::small_world(), "bitset", 0.1);
  const auto found = match({.grid = {.max_points = 40}}, local).hypotheses;
  ASSERT_FALSE(found.empty());
  for (const Hypothesis& h : found) {
    EXPECT_DOUBLE_EQ(h.quality, contact->share(local.points, Transform(seen_from_above(h.map_from_local))));
  }
}

TEST(BranchAndBound, OnePointFitsAllAlongTheWalls) {
  const Points one = test::points_of({{1.0F, 0.0F, 0.0F}});
  const auto found =
      match({.grid = {.max_poses = 10}, .refinement = on_the_grid}, local_of(one), 1.0).hypotheses;
  ASSERT_FALSE(found.empty());
  for (const Hypothesis& h : found) EXPECT_EQ(h.score, 1.0);
}

TEST(BranchAndBound, AMapOfOnePointTouchesOnePointOfMany) {
  const Points dot = test::points_of({{3.0F, -2.0F, 0.0F}});
  Points spread;
  for (int i = 0; i < 10; ++i) spread.push_back({static_cast<float>(i), 0.0F, 0.0F});
  const auto found = match({.refinement = on_the_grid}, local_of(spread), 0.0, map_of(dot)).hypotheses;
  ASSERT_FALSE(found.empty());
  EXPECT_DOUBLE_EQ(found.front().score, 0.1);
  EXPECT_TRUE(match({.refinement = on_the_grid}, local_of(spread), 0.11, map_of(dot)).hypotheses.empty());
}

TEST(BranchAndBound, AThresholdOfOneAsksForAllPoints) {
  const Pose2 truth{2.0, 2.0, 0.0};
  const auto all = match({.refinement = on_the_grid}, local_map_at(truth, 2.5), 1.0).hypotheses;
  ASSERT_FALSE(all.empty());
  EXPECT_LT(distance(all.front().map_from_local, truth), 0.2);
  LocalMap off = local_map_at(truth, 2.5);
  off.points.push_back({2.5F, 2.5F, 0.0F});  // nothing stands there
  EXPECT_TRUE(match({.grid = {.max_points = 0}, .refinement = on_the_grid}, off, 1.0).hypotheses.empty());
}

TEST(BranchAndBound, WithoutAThresholdAnyContactIsEnough) {
  const auto found =
      match({.grid = {.max_poses = 30}, .refinement = on_the_grid}, local_map_at({2.0, 2.0, 0.0}, 2.5), 0.0)
          .hypotheses;
  ASSERT_FALSE(found.empty());
  EXPECT_LE(found.size(), 30U);
  EXPECT_GT(found.back().score, 0.0);
}

TEST(BranchAndBound, AnEmptyLocalMapFitsNowhere) {
  EXPECT_TRUE(match({}, LocalMap{}, 0.0).hypotheses.empty());
}

TEST(BranchAndBound, AnswersAlikeForAnyNumberOfThreads) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  const MatchResult one = match({}, local, 0.1, test::small_world(), 1);
  const MatchResult two = match({}, local, 0.1, test::small_world(), 2);
  test::expect_same_answer(one, two);
}

TEST(BranchAndBound, RefusesCellsLargerThanTheEpsilonOfTheMap) {
  // Epsilon is not said, and so that of the setup: nobody could tell before the map was there.
  const StageSetup setup{.map = test::small_world(), .contact_epsilon = 0.04};
  EXPECT_THROW(BranchAndBound({.grid = {.cell = 0.05}}, setup), ConfigError);
  EXPECT_NO_THROW(BranchAndBound({.grid = {.cell = 0.04}}, setup));
  EXPECT_NO_THROW(BranchAndBound({.grid = {.contact_epsilon = 0.05, .cell = 0.05}}, setup));
}

}  // namespace
}  // namespace glocal::grid_search::branch_and_bound_test
