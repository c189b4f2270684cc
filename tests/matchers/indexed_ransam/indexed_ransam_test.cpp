#include "matchers/indexed_ransam/indexed_ransam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "files.hpp"
#include "glocal/yaml.hpp"
#include "matchers/same_answer.hpp"
#include "test_world.hpp"

namespace glocal::indexed_ransam::indexed_ransam_test {
namespace {

using test::local_map_at;

MatchResult match(const IndexedRansam::Params& params, const LocalMap& local, std::uint64_t seed = 1) {
  IndexedRansam matcher(params, {test::small_world(), 1});
  Rng rng(seed);
  return matcher.match({local, {}, 0.1}, rng);
}

TEST(IndexedRansam, FindsThePoseFromAnywhereWithFewDraws) {
  Rng rng(6);
  int first = 0;
  constexpr int places = 40;
  for (int i = 0; i < places; ++i) {
    const Pose2 truth = test::somewhere_in_small_world(i, rng);
    const MatchResult result = match({}, local_map_at(truth, 4.0), static_cast<std::uint64_t>(i));
    ASSERT_FALSE(result.hypotheses.empty());
    const Pose3& best = result.hypotheses.front().map_from_local;
    if (distance(best, truth) < 0.05 && rotation_between(best, truth) < radians(1.0)) ++first;
  }
  // The world looks like itself in places, seen from near by.
  EXPECT_GE(first, places - 2);
}

TEST(IndexedRansam, ProposalsGrowWithTheMapUpToABound) {
  EXPECT_EQ(IndexedRansam::proposals_on(1'000, 600), 600U);
  EXPECT_EQ(IndexedRansam::proposals_on(80'000, 600), 600U);
  EXPECT_EQ(IndexedRansam::proposals_on(200'000, 600), 1500U);
  EXPECT_EQ(IndexedRansam::proposals_on(10'000'000, 600), 24'000U);
  EXPECT_EQ(IndexedRansam::proposals_on(10'000'000, 30'000), 30'000U);
}

TEST(IndexedRansam, HypothesesAreDistinctPoses) {
  const IndexedRansam::Params params;
  const MatchResult result = match(params, local_map_at({2.0, 6.0, -1.0}, 2.5));
  ASSERT_GT(result.hypotheses.size(), 1U);
  EXPECT_LE(result.hypotheses.size(), static_cast<std::size_t>(params.candidates));
  for (std::size_t i = 0; i < result.hypotheses.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Pose3& a = result.hypotheses[i].map_from_local;
      const Pose3& b = result.hypotheses[k].map_from_local;
      EXPECT_TRUE(distance(a, b) >= candidate_distance || rotation_between(a, b) >= candidate_rotation);
    }
  }
}

TEST(IndexedRansam, TheScoreIsContactLessWhatSpeaksAgainstAPose) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  const auto contact = contact_index(*test::small_world(), "bitset", 0.1);
  const auto found = match({.unknown_weight = 0.0}, local).hypotheses;
  ASSERT_FALSE(found.empty());
  for (const Hypothesis& h : found) {
    const std::size_t n = local.points.size();
    const auto in_contact =
        static_cast<double>(contact->count(local.points, 0, n, Transform(seen_from_above(h.map_from_local))));
    EXPECT_NEAR(h.quality, in_contact / static_cast<double>(n), 1e-12);
    // Without beams there are points in free space, and their distances to the map.
    EXPECT_LE(h.score, h.quality);
    EXPECT_GE(h.score, h.quality - 0.25 - 0.05);
  }
}

TEST(IndexedRansam, BlockedBeamsLowerTheScoreAndLeaveTheQuality) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const LocalMap local = local_map_at(truth, 3.0);
  Observation through_the_wall;
  through_the_wall.scan.free_ends.push_back({9.0F, 0.0F, 0.0F});
  MapData data;
  data.points = test::small_world_points();
  data.grid = {{-0.05, -0.05, 0.0}, 0.1, 82, 92, PackedCells(std::size_t{82} * 92, Cell::free)};
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    data.grid.cell(static_cast<int>((data.points.x[i] + 0.05) / 0.1),
                   static_cast<int>((data.points.y[i] + 0.05) / 0.1)) = Cell::occupied;
  }
  const auto map = std::make_shared<const GlobalMap>(std::move(data));
  const auto best = [&](const Observation& latest) {
    IndexedRansam matcher({.beams = {.weight = 0.25}}, {map, 1});
    Rng rng(1);
    return matcher.match({local, latest, 0.1}, rng).hypotheses.front();
  };
  const Hypothesis free = best({});
  const Hypothesis blocked = best(through_the_wall);
  EXPECT_LT(distance(free.map_from_local, truth), 0.05);
  EXPECT_NEAR(free.score - blocked.score, 0.25, 0.02);
  EXPECT_NEAR(free.quality, blocked.quality, 0.02);
}

TEST(IndexedRansam, TheBestPosesAreCarriedToTheNextStep) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const LocalMap local = local_map_at(truth, 3.0);
  // Draws in the first four steps only.
  IndexedRansam matcher({.iterations = 0}, {test::small_world(), 1});
  Rng rng(1);
  for (int i = 0; i < 4; ++i) {
    const MatchResult drawn = matcher.match({local, {}, 0.1}, rng);
    EXPECT_GT(drawn.proposals, 0U);
    ASSERT_FALSE(drawn.hypotheses.empty());
  }
  const MatchResult fifth = matcher.match({local, {}, 0.1}, rng);
  EXPECT_EQ(fifth.proposals, 0U);
  ASSERT_FALSE(fifth.hypotheses.empty());
  EXPECT_LT(distance(fifth.hypotheses.front().map_from_local, truth), 0.05);
  // Another local frame, or a reset: nothing to carry. The first step comes again, with its draws.
  LocalMap restarted = local;
  restarted.epoch = 1;
  EXPECT_GT(matcher.match({restarted, {}, 0.1}, rng).proposals, 0U);
  matcher.reset();
  EXPECT_GT(matcher.match({local, {}, 0.1}, rng).proposals, 0U);
}

/// The same room twelve times, 20 m apart: as many right poses.
std::shared_ptr<const GlobalMap> twelve_worlds() {
  MapData data;
  const Points room = test::small_world_points();
  for (int i = 0; i < 12; ++i) {
    for (std::size_t k = 0; k < room.size(); ++k)
      data.points.push_back({room.x[k] + 20.0F * static_cast<float>(i), room.y[k], 0.0F});
  }
  return std::make_shared<const GlobalMap>(std::move(data));
}

// Of fewer candidates than there are right poses, each is where the prior says, in the first step and in
// those that carry poses on.
TEST(IndexedRansam, LookAlikesOutsideOfAPriorTakeNoPlaceOfTheRightPose) {
  const Pose2 in_room{5.5, 2.5, 0.7};
  const LocalMap local = local_map_at(in_room, 4.0);
  const Pose2 local_from_start{-1.0, 2.0, 0.3};
  for (const int room : {0, 7, 11}) {
    const Pose2 truth{in_room.x + 20.0 * room, in_room.y, in_room.theta};
    const Pose2 start = truth * local_from_start;
    const PoseGate gate({.region = {start.x + 1.0, start.y, 2.0}, .heading = {}}, local_from_start);
    IndexedRansam matcher({.candidates = 4, .best = 2, .carried = 2}, {twelve_worlds(), 1});
    Rng rng(3);
    for (int step = 0; step < 6; ++step) {
      const auto found = matcher.match({local, {}, 0.1, gate}, rng).hypotheses;
      for (const Hypothesis& h : found) EXPECT_TRUE(gate.allows(h.map_from_local));
      if (step < 4) continue;
      ASSERT_FALSE(found.empty());
      EXPECT_LT(distance(found.front().map_from_local, truth), 0.05) << room;
    }
  }
}

TEST(IndexedRansam, TheExactSearchKeepsToThePrior) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 4.0);
  const PoseGate gate({.region = {145.0, 2.5, 2.0}, .heading = {}}, {});  // the room from x = 140 m on
  IndexedRansam::Params params{.iterations = 0, .first_iterations = 0, .best = 2};
  params.exact_search = {.after_steps = 1, .max_poses = 4};
  IndexedRansam matcher(params, {twelve_worlds(), 1});
  Rng rng(3);
  const auto found = matcher.match({local, {}, 0.1, gate}, rng).hypotheses;
  ASSERT_FALSE(found.empty());
  EXPECT_LT(distance(found.front().map_from_local, Pose2{145.5, 2.5, 0.7}), 0.05);
}

TEST(IndexedRansam, LargeLocalMapsDoNotStarveTheDraws) {
  // Two walls far apart: most pairs of points are longer than any oriented point pair.
  LocalMap local;
  test::add_wall(local.points, {{0, 0}, {8, 0}});
  test::add_wall(local.points, {{100, 0}, {108, 0}});
  test::add_wall(local.points, {{0, 100}, {8, 100}});
  local.ends = {local.points.size()};
  EXPECT_GT(match({.first_iterations = 1000}, local).proposals, 500U);
}

TEST(IndexedRansam, SaysWhatTookThePlaceOfAdaptiveDraws) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("params.yaml", "adaptive: {limit: 5000}\n");
  ParamsOf<IndexedRansam::Params> params;
  EXPECT_NE(test::config_error(folder / "", [&] { read_yaml(file, params); })
                .find("the number of draws is fixed; set iterations and first_iterations"),
            std::string::npos);
}

/// Round pillars 10 cm thick, too thin to have a normal, some 2 m apart from each other in 16 m x 16 m.
Points pillars() {
  Rng rng(3);
  Points points;
  std::vector<Point> middles;
  while (middles.size() < 45) {
    const Point middle{static_cast<float>(rng.uniform(0.0, 16.0)), static_cast<float>(rng.uniform(0.0, 16.0)),
                       0.0F};
    const bool is_near = std::any_of(middles.begin(), middles.end(), [&](const Point& other) {
      return std::hypot(other.x - middle.x, other.y - middle.y) < 1.0F;
    });
    if (is_near) continue;
    middles.push_back(middle);
    for (int i = 0; i < 8; ++i) {
      const float angle = 0.7854F * static_cast<float>(i);
      points.push_back({middle.x + 0.05F * std::cos(angle), middle.y + 0.05F * std::sin(angle), 0.0F});
    }
  }
  return points;
}

TEST(IndexedRansam, TrianglesFindARobotAmongPillarsWherePairsCannot) {
  MapData data;
  data.points = pillars();
  data.grid = {{-1.0, -1.0, 0.0}, 0.1, 180, 180, PackedCells(std::size_t{180} * 180, Cell::free)};
  const auto map = std::make_shared<const GlobalMap>(std::move(data));
  Rng rng(9);
  for (int place = 0; place < 10; ++place) {
    const Pose2 truth{rng.uniform(5.0, 11.0), rng.uniform(5.0, 11.0), rng.uniform(-3.14, 3.14)};
    LocalMap local;
    local.points = test::seen_from(map->points(), truth, 5.0);
    local.ends = {local.points.size()};
    const auto answer = [&](const char* relation, int threads) {
      IndexedRansam matcher({.relation = relation}, {map, threads});
      Rng draws(static_cast<std::uint64_t>(place));
      return matcher.match({local, {}, 0.5}, draws).hypotheses;
    };
    for (const char* relation : {"triangle", "auto"}) {
      const std::vector<Hypothesis> found = answer(relation, 1);
      ASSERT_FALSE(found.empty()) << relation;
      EXPECT_LT(distance(found.front().map_from_local, truth), 0.05) << relation;
      EXPECT_LT(rotation_between(found.front().map_from_local, truth), radians(1.0)) << relation;
      const std::vector<Hypothesis> parallel = answer(relation, 2);
      ASSERT_EQ(found.size(), parallel.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].map_from_local, parallel[i].map_from_local);
        EXPECT_EQ(found[i].quality, parallel[i].quality);
        EXPECT_EQ(found[i].score, parallel[i].score);
      }
    }
    EXPECT_TRUE(answer("oriented_pair", 1).empty());
  }
}

TEST(IndexedRansam, AnExactSearchFindsWhatDrawsDoNot) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const LocalMap local = local_map_at(truth, 3.0);
  // No pose is ever clear, and nothing is ever drawn.
  IndexedRansam::Params params{.iterations = 0, .first_iterations = 0};
  params.exact_search = {.after_steps = 2, .margin = 1.0};
  IndexedRansam matcher(params, {test::small_world(), 1});
  Rng rng(1);
  const auto match = [&](const LocalMap& map) { return matcher.match({map, {}, 0.1}, rng).hypotheses; };
  EXPECT_TRUE(match(local).empty());
  const auto found = match(local);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(distance(found.front().map_from_local, truth), 0.05);
  // A reset, or another local frame, begins the count anew.
  matcher.reset();
  EXPECT_TRUE(match(local).empty());
  LocalMap restarted = local;
  restarted.epoch = 1;
  EXPECT_TRUE(match(restarted).empty());
  EXPECT_FALSE(match(restarted).empty());
}

TEST(IndexedRansam, AMatchInPiecesComesToTheSameEnd) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  IndexedRansam::Params params{.iterations = 0, .first_iterations = 0};
  params.exact_search = {.after_steps = 1, .margin = 1.0};
  IndexedRansam whole(params, {test::small_world(), 1});
  StageSetup setup{test::small_world(), 1};
  setup.looks_per_step = 1;
  IndexedRansam in_pieces(params, setup);
  Rng rng(1), same(1);
  const MatchResult wanted = whole.match({local, {}, 0.1}, rng);
  EXPECT_FALSE(wanted.goes_on);
  MatchResult found = in_pieces.match({local, {}, 0.1}, same);
  ASSERT_TRUE(found.goes_on);
  EXPECT_TRUE(found.hypotheses.empty());
  for (std::size_t looks = 1; found.goes_on; looks *= 2) found = in_pieces.go_on(local, looks);
  test::expect_same_answer(found, wanted);
  EXPECT_EQ(found.proposals, wanted.proposals);
}

TEST(IndexedRansam, AClearBestPoseNeedsNoExactSearch) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  IndexedRansam::Params params{.iterations = 0};
  params.exact_search = {.after_steps = 1, .margin = 0.0};
  IndexedRansam matcher(params, {test::small_world(), 1});
  Rng rng(1);
  for (int i = 0; i < 3; ++i) (void)matcher.match({local, {}, 0.1}, rng);
  (void)matcher.match({local, {}, 0.1}, rng);
  EXPECT_EQ(matcher.match({local, {}, 0.1}, rng).proposals, 0U);
}

}  // namespace
}  // namespace glocal::indexed_ransam::indexed_ransam_test
