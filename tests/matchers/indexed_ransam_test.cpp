#include "matchers/indexed_ransam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "test_world.hpp"

namespace glocal {
namespace {

using testing::local_map_at;

MatchResult match(const IndexedRansam::Params& params, const LocalMap& local, std::uint64_t seed = 1) {
  IndexedRansam matcher(params, {testing::small_world(), 1});
  Rng rng(seed);
  return matcher.match(local, {}, 0.1, rng);
}

TEST(IndexedRansam, FindsThePoseFromAnywhereWithFewDraws) {
  Rng rng(6);
  int first = 0;
  constexpr int places = 40;
  for (int i = 0; i < places; ++i) {
    const bool lower = i % 2 == 0;
    const Pose2 truth{rng.uniform(1.0, lower ? 7.0 : 3.0),
                      lower ? rng.uniform(1.0, 4.0) : rng.uniform(5.0, 8.0), rng.uniform(-3.14, 3.14)};
    const MatchResult result = match({}, local_map_at(truth, 4.0), static_cast<std::uint64_t>(i));
    ASSERT_FALSE(result.hypotheses.empty());
    const Pose2& best = result.hypotheses.front().map_from_robot;
    if (distance(best, truth) < 0.05 && rotation_between(best, truth) < radians(1.0)) ++first;
  }
  // The world looks like itself in places, seen from near by.
  EXPECT_GE(first, places - 2);
}

TEST(IndexedRansam, HypothesesAreDistinctPoses) {
  const IndexedRansam::Params params;
  const MatchResult result = match(params, local_map_at({2.0, 6.0, -1.0}, 2.5));
  ASSERT_GT(result.hypotheses.size(), 1U);
  EXPECT_LE(result.hypotheses.size(), static_cast<std::size_t>(params.modes));
  for (std::size_t i = 0; i < result.hypotheses.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Pose2& a = result.hypotheses[i].map_from_robot;
      const Pose2& b = result.hypotheses[k].map_from_robot;
      EXPECT_TRUE(distance(a, b) >= params.mode_distance || rotation_between(a, b) >= params.mode_rotation);
    }
  }
}

TEST(IndexedRansam, QualityIsContactWhereNothingSpeaksAgainstAPose) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  const auto contact = contact_index(*testing::small_world(), "bitset", 0.1);
  for (const Hypothesis& h : match({.unknown_weight = 0.0}, local).hypotheses) {
    const std::size_t n = local.points.size();
    const auto in_contact =
        static_cast<double>(contact->count(local.points, 0, n, Transform(h.map_from_local)));
    EXPECT_NEAR(h.quality, in_contact / static_cast<double>(n), 1e-12);
  }
}

TEST(IndexedRansam, BlockedBeamsTakeQualityOff) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const LocalMap local = local_map_at(truth, 3.0);
  Observation through_the_wall;
  through_the_wall.scan.free_ends.push_back({9.0F, 0.0F, 0.0F});
  MapData data;
  data.points = testing::small_world_points();
  data.grid = {{-0.05, -0.05, 0.0}, 0.1, 82, 92, std::vector<Cell>(std::size_t{82} * 92, Cell::free)};
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    data.grid.cell(static_cast<int>((data.points.x[i] + 0.05) / 0.1),
                   static_cast<int>((data.points.y[i] + 0.05) / 0.1)) = Cell::occupied;
  }
  const auto map = std::make_shared<const GlobalMap>(std::move(data));
  const auto best = [&](const Observation& latest) {
    IndexedRansam matcher({.blocked_weight = 0.25}, {map, 1});
    Rng rng(1);
    return matcher.match(local, latest, 0.1, rng).hypotheses.front();
  };
  const Hypothesis free = best({});
  const Hypothesis blocked = best(through_the_wall);
  EXPECT_LT(distance(free.map_from_robot, truth), 0.05);
  EXPECT_NEAR(free.quality - blocked.quality, 0.25, 0.02);
}

TEST(IndexedRansam, TheBestPosesAreCarriedToTheNextStep) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const LocalMap local = local_map_at(truth, 3.0);
  // Draws in the first step only.
  IndexedRansam matcher({.iterations = 0, .first_steps = 1}, {testing::small_world(), 1});
  Rng rng(1);
  ASSERT_FALSE(matcher.match(local, {}, 0.1, rng).hypotheses.empty());
  const MatchResult second = matcher.match(local, {}, 0.1, rng);
  EXPECT_EQ(second.collisions, 0U);
  ASSERT_FALSE(second.hypotheses.empty());
  EXPECT_LT(distance(second.hypotheses.front().map_from_robot, truth), 0.05);
  // Another local frame, or a reset: nothing to carry. The first step comes again, with its draws.
  LocalMap restarted = local;
  restarted.generation = 1;
  EXPECT_GT(matcher.match(restarted, {}, 0.1, rng).collisions, 0U);
  matcher.reset();
  EXPECT_GT(matcher.match(local, {}, 0.1, rng).collisions, 0U);
}

TEST(IndexedRansam, LargeLocalMapsDoNotStarveTheDraws) {
  // Two walls far apart: most pairs of points are longer than any dipole.
  LocalMap local;
  testing::add_wall(local.points, {{0, 0}, {8, 0}});
  testing::add_wall(local.points, {{100, 0}, {108, 0}});
  testing::add_wall(local.points, {{0, 100}, {8, 100}});
  local.ends = {local.points.size()};
  EXPECT_GT(match({.first_iterations = 1000}, local).collisions, 500U);
}

TEST(IndexedRansam, AnExactSearchFindsWhatDrawsDoNot) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const LocalMap local = local_map_at(truth, 3.0);
  // No pose is ever clear, and nothing is ever drawn.
  IndexedRansam::Params params{.iterations = 0, .first_iterations = 0};
  params.exact_search = {.after_steps = 2, .margin = 1.0};
  const auto hypotheses_of_steps = [&](const LocalMap& first, IndexedRansam& matcher) {
    std::vector<std::size_t> n;
    Rng rng(1);
    for (int i = 0; i < 2; ++i) n.push_back(matcher.match(first, {}, 0.1, rng).hypotheses.size());
    return n;
  };
  IndexedRansam matcher(params, {testing::small_world(), 1});
  EXPECT_EQ(hypotheses_of_steps(local, matcher), (std::vector<std::size_t>{0, 0}));
  Rng rng(1);
  const auto found = matcher.match(local, {}, 0.1, rng).hypotheses;
  ASSERT_FALSE(found.empty());
  EXPECT_LT(distance(found.front().map_from_robot, truth), 0.05);
  // A reset, or another local frame, begins the count anew.
  matcher.reset();
  EXPECT_EQ(hypotheses_of_steps(local, matcher), (std::vector<std::size_t>{0, 0}));
  LocalMap restarted = local;
  restarted.generation = 1;
  EXPECT_TRUE(matcher.match(restarted, {}, 0.1, rng).hypotheses.empty());
}

TEST(IndexedRansam, AClearBestPoseNeedsNoExactSearch) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  IndexedRansam::Params params{.iterations = 0};
  params.exact_search = {.after_steps = 1, .margin = 0.0};
  IndexedRansam matcher(params, {testing::small_world(), 1});
  Rng rng(1);
  for (int i = 0; i < 3; ++i) (void)matcher.match(local, {}, 0.1, rng);
  (void)matcher.match(local, {}, 0.1, rng);
  EXPECT_EQ(matcher.match(local, {}, 0.1, rng).collisions, 0U);
}

}  // namespace
}  // namespace glocal
