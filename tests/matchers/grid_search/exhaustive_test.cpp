#include "matchers/grid_search/exhaustive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "matchers/grid_search/branch_and_bound.hpp"
#include "matchers/same_answer.hpp"
#include "points.hpp"
#include "test_world.hpp"

namespace glocal::grid_search::exhaustive_test {
namespace {

using test::local_map_at;
using test::map_of;
using test::random_points;

constexpr PoseRefinement on_the_grid{.iterations = 0};

template <class Kind>
MatchResult match(const typename Kind::Params& params, const LocalMap& local, double omega_max,
                  std::shared_ptr<const GlobalMap> map, int threads = 1) {
  Kind matcher(params, {std::move(map), threads});
  Rng rng(1);
  return matcher.match({local, {}, omega_max}, rng);
}

/// Omega as its definition says.
double omega(const Points& map, const Points& local, const Pose2& map_from_local, double epsilon) {
  std::size_t in_contact = 0;
  for (std::size_t i = 0; i < local.size(); ++i) {
    const Pose2 at = map_from_local * Pose2{local.x[i], local.y[i], 0.0};
    bool any = false;
    for (std::size_t k = 0; k < map.size(); ++k) {
      any = any || std::hypot(map.x[k] - at.x, map.y[k] - at.y) <= epsilon;
    }
    in_contact += any ? 1 : 0;
  }
  return static_cast<double>(in_contact) / static_cast<double>(local.size());
}

TEST(Exhaustive, FindsTheBestPoseOfAllOfTheGrid) {
  constexpr double cell = 0.5;
  constexpr double epsilon = 0.5;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Rng rng(seed);
    const Points map = random_points(rng, 30, 6.0, 4.0);
    LocalMap local;
    local.points = random_points(rng, 9, 3.0, 1.5);
    local.ends = {local.points.size()};

    double best = 0.0;
    const CellFrame frame = cell_frame(map, cell, epsilon);
    const PoseGrid grid(local.points, frame, 0.1);
    for (std::size_t rotation = 0; rotation < grid.rotations(0); ++rotation) {
      for (int row = -15; row < frame.rows + 15; ++row) {
        for (int column = -15; column < frame.columns + 15; ++column) {
          const Pose2 pose = grid.pose(0, rotation, column, row);
          best = std::max(best, omega(map, local.points, pose, epsilon));
        }
      }
    }
    const Exhaustive::Params params{.matching = {.grid = {.contact_epsilon = epsilon,
                                                          .cell = cell,
                                                          .min_rotation_step_deg = degrees(0.1)},
                                                 .refinement = on_the_grid},
                                    .contact = "kd_tree"};
    const auto found = match<Exhaustive>(params, local, 0.1, map_of(map)).hypotheses;
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found.front().score, best);
    for (const Hypothesis& h : found) {
      EXPECT_EQ(h.score, omega(map, local.points, seen_from_above(h.map_from_local), epsilon));
    }
  }
}

/// Where both search the same grid, at several places of the small world.
class BesideBranchAndBound : public ::testing::TestWithParam<int> {
 protected:
  BesideBranchAndBound() {
    Rng rng(static_cast<std::uint64_t>(GetParam()));
    local_ = local_map_at(test::somewhere_in_small_world(GetParam(), rng), 3.0);
    // Things the map does not show: a tenth of the points.
    const Points clutter = random_points(rng, local_.points.size() / 10, 2.0, 2.0);
    for (std::size_t i = 0; i < clutter.size(); ++i) local_.points.push_back(clutter[i]);
    local_.ends = {local_.points.size()};
  }
  LocalMap local_;
};

TEST_P(BesideBranchAndBound, TheBestPosesAreEquallyGood) {
  const auto best_of = [](const MatchResult& result) { return result.hypotheses.front().score; };
  const GridMatching matching{.grid = {.contact_epsilon = 0.3, .cell = 0.15, .max_points = 60},
                              .refinement = on_the_grid};
  const double bounded = best_of(match<BranchAndBound>(matching, local_, 0.3, test::small_world()));
  // A cell is in contact as its centre is, which is half a diagonal of a cell nearer or farther than the
  // point; a voxel of the bitset as its own. Whole cells leave the grid where it is.
  const auto at = [&](double epsilon) {
    Exhaustive::Params params{.matching = matching};
    params.matching.grid.contact_epsilon = epsilon;
    return best_of(match<Exhaustive>(params, local_, 0.3, test::small_world()));
  };
  EXPECT_GE(bounded, at(*matching.grid.contact_epsilon - matching.grid.cell));
  EXPECT_LE(bounded, at(*matching.grid.contact_epsilon + 2.0 * matching.grid.cell));
}

TEST_P(BesideBranchAndBound, TheSamePoseIsBestOnceRefined) {
  const GridMatching matching{.grid = {.contact_epsilon = 0.15, .cell = 0.15, .max_points = 60}};
  const auto bounded = match<BranchAndBound>(matching, local_, 0.5, test::small_world()).hypotheses;
  const auto all = match<Exhaustive>({.matching = matching}, local_, 0.5, test::small_world()).hypotheses;
  ASSERT_FALSE(bounded.empty());
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front().quality, bounded.front().quality);
  EXPECT_LT(distance(all.front().map_from_local, bounded.front().map_from_local), 0.01);
  EXPECT_LT(rotation_between(all.front().map_from_local, bounded.front().map_from_local), 0.01);
}

INSTANTIATE_TEST_SUITE_P(SmallWorld, BesideBranchAndBound, ::testing::Range(0, 4));

TEST(Exhaustive, AnEmptyLocalMapFitsNowhere) {
  EXPECT_TRUE(match<Exhaustive>({}, LocalMap{}, 0.0, test::small_world()).hypotheses.empty());
}

TEST(Exhaustive, AnswersAlikeForAnyNumberOfThreads) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  const Exhaustive::Params params{.matching = {.grid = {.contact_epsilon = 0.2, .cell = 0.2}}};
  const MatchResult one = match<Exhaustive>(params, local, 0.1, test::small_world(), 1);
  const MatchResult two = match<Exhaustive>(params, local, 0.1, test::small_world(), 2);
  test::expect_same_answer(one, two);
}

}  // namespace
}  // namespace glocal::grid_search::exhaustive_test
