#include "matchers/indexed_ransam/pose_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "glocal/rng.hpp"

namespace glocal::indexed_ransam::pose_judge_test {
namespace {

/// A wall along x = 4 m, from y = 0 to 8 m, in free cells; from x = 6 m on nothing is known.
std::shared_ptr<const GlobalMap> map_with_a_wall() {
  MapData data;
  data.grid = {{0.0, 0.0, 0.0}, 0.1, 80, 80, PackedCells(6400, Cell::free)};
  for (int row = 0; row < 80; ++row) {
    data.grid.cell(40, row) = Cell::occupied;
    for (int column = 60; column < 80; ++column) data.grid.cell(column, row) = Cell::unknown;
  }
  data.points = occupied_centres(data.grid);
  return std::make_shared<const GlobalMap>(std::move(data));
}

/// Ten points in a row along y, 0.1 m apart.
LocalMap row_of_points() {
  LocalMap local;
  for (int i = 0; i < 10; ++i) local.points.push_back({0.0F, 0.1F * static_cast<float>(i), 0.0F});
  local.ends = {10};
  return local;
}

PoseJudge judge_of(const JudgeRule& rule) {
  const auto map = map_with_a_wall();
  return {rule, map, contact_index(*map, "kd_tree", rule.contact_epsilon), distance_field(*map, 1)};
}

const Pose2 on_the_wall{4.05, 1.05, 0.0};
const Pose2 half_on_the_wall{4.05, 7.55, 0.0};  // five of ten points lie beyond its end
const Pose2 in_the_unknown{7.05, 1.05, 0.0};
const Pose2 in_the_open{2.05, 1.05, 0.0};

std::vector<Candidate> candidates(const std::vector<Pose2>& poses) {
  std::vector<Candidate> result;
  for (const Pose2& pose : poses) result.push_back({pose, 0.5});
  return result;
}

TEST(PoseJudge, ScoresContactAndUnknownCells) {
  const LocalMap local = row_of_points();
  const PoseJudge judge =
      judge_of({.unknown_weight = 0.1, .free_space_weight = 0.0, .fit_weight = 0.0, .contact_epsilon = 0.03});
  const auto best = judge.best_of(candidates({in_the_open, half_on_the_wall, in_the_unknown, on_the_wall}),
                                  local, local.points);
  ASSERT_EQ(best.size(), 4U);
  EXPECT_EQ(best[0].map_from_local, on_the_wall);
  EXPECT_EQ(best[0].quality, 1.0);
  EXPECT_EQ(best[0].score, 1.0);
  // What lies off the grid is unknown, too.
  EXPECT_EQ(best[1].map_from_local, half_on_the_wall);
  EXPECT_NEAR(best[1].quality, 0.5, 1e-12);
  EXPECT_NEAR(best[1].score, 0.55, 1e-12);
  EXPECT_EQ(best[2].map_from_local, in_the_unknown);
  EXPECT_EQ(best[2].quality, 0.0);
  EXPECT_NEAR(best[2].score, 0.1, 1e-12);
  EXPECT_EQ(best[3].score, 0.0);
}

TEST(PoseJudge, PointsInFreeCellsOutOfContactSpeakAgainstAPose) {
  const LocalMap local = row_of_points();
  const PoseJudge judge =
      judge_of({.unknown_weight = 0.0, .free_space_weight = 0.4, .fit_weight = 0.0, .contact_epsilon = 0.03});
  const Pose2 across_the_wall{3.65, 1.05,
                              -std::numbers::pi / 2.0};  // its points lie along x, one of them on the wall
  const auto best = judge.best_of(candidates({across_the_wall, in_the_open, in_the_unknown, on_the_wall}),
                                  local, local.points);
  ASSERT_EQ(best.size(), 4U);
  EXPECT_EQ(best[0].score, 1.0);
  EXPECT_EQ(best[1].map_from_local, in_the_unknown);
  EXPECT_EQ(best[1].score, 0.0);
  EXPECT_NEAR(best[2].score, 0.1 - 0.4 * 0.9, 1e-6);
  EXPECT_NEAR(best[3].score, -0.4, 1e-12);
}

TEST(PoseJudge, OfTwoPosesInFullContactTheOneThatFitsMoreCloselyIsTheBetter) {
  const LocalMap local = row_of_points();
  const PoseJudge judge =
      judge_of({.unknown_weight = 0.0, .free_space_weight = 0.0, .fit_weight = 0.2, .contact_epsilon = 0.1});
  const Pose2 beside_the_wall{4.11, 1.05, 0.0};
  const auto best =
      judge.best_of(candidates({beside_the_wall, on_the_wall, in_the_open}), local, local.points);
  ASSERT_EQ(best.size(), 3U);
  constexpr double step = 0.2 * 0.002 / 0.1;  // the field's distances are steps of 2 mm
  EXPECT_EQ(best[0].map_from_local, on_the_wall);
  EXPECT_EQ(best[0].quality, 1.0);
  EXPECT_NEAR(best[0].score, 1.0, step);
  EXPECT_EQ(best[1].quality, 1.0);
  EXPECT_NEAR(best[1].score, 1.0 - 0.2 * 0.6, step);
  // Farther away than contact_epsilon does not count as more.
  EXPECT_NEAR(best[2].score, -0.2, 1e-12);
}

TEST(PoseJudge, BlockedBeamsLowerTheScoreUpToTheCap) {
  const LocalMap local = row_of_points();
  Scan scan;
  scan.origin = {-1.0F, 0.0F, 0.0F};
  scan.hits.push_back({1.0F, 0.0F, 0.0F});        // through the wall
  scan.free_ends.push_back({-2.0F, 0.0F, 0.0F});  // away from it
  for (const double cap : {1.0, 0.3}) {
    PoseJudge judge = judge_of({.beams = {.weight = 0.8, .cap = cap},
                                .free_space_weight = 0.0,
                                .fit_weight = 0.0,
                                .contact_epsilon = 0.03});
    judge.take_in(local, scan);
    auto best = judge.best_of(candidates({on_the_wall}), local, local.points);
    EXPECT_EQ(best.front().quality, 1.0);
    EXPECT_NEAR(best.front().score, 1.0 - 0.8 * std::min(cap, 0.5), 1e-12);
    judge.forget();
    best = judge.best_of(candidates({on_the_wall}), local, local.points);
    EXPECT_EQ(best.front().score, 1.0);
  }
}

// Although not all of them are looked at.
TEST(PoseJudge, TheBestAreThoseOfAllJudgedOneByOne) {
  const LocalMap local = row_of_points();
  Scan scan;
  for (const float y : {-2.0F, 0.0F, 2.0F}) scan.hits.push_back({1.5F, y, 0.0F});
  Rng rng(5);
  std::vector<Pose2> poses;
  for (int i = 0; i < 300; ++i)
    poses.push_back({rng.uniform(3.6, 4.4), rng.uniform(0.0, 8.0), rng.uniform(-0.2, 0.2)});
  const JudgeRule rule{.beams = {.weight = 1.0, .cap = 0.5}, .most = 20};
  PoseJudge judge = judge_of(rule);
  judge.take_in(local, scan);
  std::vector<double> expected;
  for (const Pose2& pose : poses)
    expected.push_back(judge.best_of(candidates({pose}), local, local.points).front().score);
  std::sort(expected.rbegin(), expected.rend());
  const auto best = judge.best_of(candidates(poses), local, local.points);
  ASSERT_EQ(best.size(), rule.most);
  for (std::size_t i = 0; i < best.size(); ++i) EXPECT_EQ(best[i].score, expected[i]);
}

TEST(PoseJudge, TellsWhatLiesInFreeSpaceAndHowUncertainAPoseIs) {
  const LocalMap local = row_of_points();
  const PoseJudge judge = judge_of({});
  const auto told = [&](const Pose2& pose, double score) {
    return judge.to_hypothesis({.map_from_local = pose, .score = score}, local, local.points);
  };
  EXPECT_EQ(told(on_the_wall, 1.05).score, 1.0);
  EXPECT_EQ(told(on_the_wall, 0.4).score, 0.4);
  EXPECT_EQ(told(on_the_wall, 1.0).free_space_violation, 0.0);
  EXPECT_EQ(told(in_the_open, 0.0).free_space_violation, 1.0);
  EXPECT_EQ(told(in_the_unknown, 0.0).free_space_violation, 0.0);
  EXPECT_LT(told(on_the_wall, 1.0).covariance.value().xx, 0.01);
  // Far from everything, points say nothing.
  EXPECT_GT(told(in_the_open, 0.0).covariance.value().xx, 0.5);
}

}  // namespace
}  // namespace glocal::indexed_ransam::pose_judge_test
