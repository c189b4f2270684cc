#include "matchers/ransam/ransam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "matchers/same_answer.hpp"
#include "test_world.hpp"

namespace glocal::ransam::ransam_test {
namespace {

using test::local_map_at;

MatchResult match(const TripleSearch& triples, const LocalMap& local, double omega_max, int threads = 1,
                  std::uint64_t seed = 1) {
  Ransam ransam({.triples = triples}, {test::small_world(), threads});
  Rng rng(seed);
  return ransam.match({local, {}, omega_max}, rng);
}

double brute_force_quality(const Points& local, const Pose3& map_from_local, double epsilon) {
  const Points world = test::small_world_points();
  const Points there = moved(local, map_from_local);
  int in_contact = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    bool contact = false;
    for (std::size_t k = 0; k < world.size() && !contact; ++k) {
      contact = std::hypot(there.x[i] - world.x[k], there.y[i] - world.y[k]) < epsilon;
    }
    in_contact += contact ? 1 : 0;
  }
  return static_cast<double>(in_contact) / static_cast<double>(there.size());
}

TEST(Ransam, FindsThePose) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const MatchResult result = match({.iterations = 50000}, local_map_at(truth, 3.0), 0.8);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_LT(distance(result.hypotheses.front().map_from_local, truth), 0.1);  // epsilon
  EXPECT_LT(rotation_between(result.hypotheses.front().map_from_local, truth), radians(2.0));
}

TEST(Ransam, APriorLeavesThoseHypothesesThatItAllows) {
  const LocalMap local = local_map_at({2.0, 6.0, -1.0}, 2.5);
  const PoseGate gate({.region = {2.5, 6.0, 1.0}, .heading = {-40.0, 60.0}}, {});
  Ransam ransam({.triples = {.iterations = 50000, .max_hypotheses = 1000000}}, {test::small_world(), 1});
  const auto match_within = [&](const PoseGate& allowed) {
    Rng rng(1);
    return ransam.match({local, {}, 0.6, allowed}, rng).hypotheses;
  };
  std::vector<Hypothesis> all = match_within({});
  const std::size_t everywhere = all.size();
  std::erase_if(all, [&](const Hypothesis& h) { return !gate.allows(h.map_from_local); });
  ASSERT_GT(all.size(), 10U);
  ASSERT_LT(all.size(), everywhere);
  const std::vector<Hypothesis> left = match_within(gate);
  ASSERT_EQ(left.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(left[i].map_from_local, all[i].map_from_local);
}

TEST(Ransam, HypothesesAreWhatTheContractSays) {
  const LocalMap local = local_map_at({2.0, 6.0, -1.0}, 2.5);
  const double omega_max = 0.6;
  const MatchResult result = match({.iterations = 50000}, local, omega_max);
  ASSERT_GT(result.hypotheses.size(), 10U);
  EXPECT_GE(result.proposals, result.hypotheses.size());
  EXPECT_GE(result.points_tested, result.hypotheses.size() * local.points.size());
  double last = 1.0;
  for (const Hypothesis& h : result.hypotheses) {
    EXPECT_GE(h.quality, omega_max);
    EXPECT_LE(h.quality, last);
    last = h.quality;
    if (&h - result.hypotheses.data() >= 200) continue;  // brute force is slow
    // The contact grid is exact up to half a voxel's diagonal: 0.018 m for epsilon 0.1 m.
    EXPECT_LE(brute_force_quality(local.points, h.map_from_local, 0.1 - 0.018), h.quality + 1e-9);
    EXPECT_GE(brute_force_quality(local.points, h.map_from_local, 0.1 + 0.018), h.quality - 1e-9);
  }
}

TEST(Ransam, AgreesWithExhaustiveSearch) {
  // Every pose on a grid of 0.1 m and 3 degrees whose quality reaches 0.9 must have a hypothesis near it, and
  // the other way round: the poses that exhaustive search finds are all there is.
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 2.5);
  const BitsetContact contact(test::small_world_points(), 0.1);
  const double omega_max = 0.75;
  const MatchResult result = match({.iterations = 200000}, local, omega_max);

  std::vector<Pose2> found;
  for (double x = 0.0; x <= 8.0; x += 0.1) {
    for (double y = 0.0; y <= 9.0; y += 0.1) {
      for (int turn = 0; turn < 120; ++turn) {
        const Pose2 pose{x, y, wrap_angle(turn * radians(3.0))};
        const Transform transform(pose);
        const std::size_t in_contact = contact.count(local.points, 0, local.points.size(), transform);
        if (static_cast<double>(in_contact) >= 0.9 * static_cast<double>(local.points.size()))
          found.push_back(pose);
      }
    }
  }
  ASSERT_FALSE(found.empty());
  const auto near = [](const Pose3& a, const Pose3& b) {
    return distance(a, b) < 0.3 && rotation_between(a, b) < 0.15;
  };
  for (const Pose2& pose : found) {
    EXPECT_TRUE(std::any_of(result.hypotheses.begin(), result.hypotheses.end(),
                            [&](const Hypothesis& h) { return near(h.map_from_local, pose); }))
        << pose.x << ' ' << pose.y << ' ' << pose.theta;
  }
  for (const Hypothesis& h : result.hypotheses) {
    if (h.quality < 0.97) continue;  // the grid is too coarse to reach 0.9 beside every lesser one
    EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                            [&](const Pose2& pose) { return near(h.map_from_local, pose); }));
  }
}

TEST(Ransam, TheNumberOfThreadsChangesNothing) {
  const LocalMap local = local_map_at({2.0, 6.0, -1.0}, 2.5);
  // So many draws that threads fill the table in two rounds; and a few near ones.
  const TripleSearch many_draws{.iterations = 600'000};
  const TripleSearch near_draws{.iterations = 60'000, .local_radius = 1.5};
  for (const TripleSearch& triples : {many_draws, near_draws}) {
    const MatchResult one = match(triples, local, 0.6, 1);
    for (const int threads : {2, 5}) {
      test::expect_same_answer(one, match(triples, local, 0.6, threads));
    }
  }
}

TEST(Ransam, ASecondMatchDoesNotDependOnTheFirst) {
  const LocalMap local = local_map_at({2.0, 6.0, -1.0}, 2.5);
  const TripleSearch triples{.iterations = 20000};
  Ransam used({.triples = triples}, {test::small_world(), 1});
  Rng other(99);
  (void)used.match({local_map_at({5.5, 2.5, 0.7}, 3.0), {}, 0.5}, other);
  Rng rng(1);
  const MatchResult second = used.match({local, {}, 0.6}, rng);
  const MatchResult fresh = match(triples, local, 0.6);
  EXPECT_EQ(second.proposals, fresh.proposals);
  ASSERT_EQ(second.hypotheses.size(), fresh.hypotheses.size());
  EXPECT_EQ(second.points_tested, fresh.points_tested);
}

TEST(Ransam, LocalDrawsGiveMoreCorrectHypothesesOnALargeMap) {
  // The small world in the corner of a large one: most triples of uniform draws are then larger than the
  // local map.
  MapData data;
  data.points = test::small_world_points();
  Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const double x = rng.uniform(10.0, 60.0);
    const double y = rng.uniform(0.0, 60.0);
    test::add_wall(data.points, {{x, y}, {x + rng.uniform(-2.0, 2.0), y + rng.uniform(-2.0, 2.0)}});
  }
  const auto map = std::make_shared<const GlobalMap>(std::move(data));
  const Pose2 truth{5.5, 2.5, 0.7};
  const auto correct = [&](double local_radius) {
    Ransam ransam({.triples = {.iterations = 50000, .local_radius = local_radius}}, {map, 1});
    Rng match_rng(1);
    const MatchResult result = ransam.match({local_map_at(truth, 3.0), {}, 0.7}, match_rng);
    return std::count_if(result.hypotheses.begin(), result.hypotheses.end(), [&](const Hypothesis& h) {
      return distance(h.map_from_local, truth) < 0.3 && rotation_between(h.map_from_local, truth) < 0.2;
    });
  };
  EXPECT_GT(correct(1.5), 2 * correct(0.0));
}

TEST(Ransam, BitsAndKdTreeFindTheSamePoses) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 3.0);
  const auto best = [&](const char* contact) {
    MatchResult result = match({.iterations = 20000, .contact = contact}, local, 0.8);
    EXPECT_GT(result.hypotheses.size(), 10U);
    return result;
  };
  const MatchResult bits = best("bitset");
  const MatchResult tree = best("kd_tree");
  EXPECT_EQ(bits.proposals, tree.proposals);
  EXPECT_LT(distance(bits.hypotheses.front().map_from_local, tree.hypotheses.front().map_from_local), 0.1);
  // Every hypothesis of the exact index has the quality brute force finds.
  for (std::size_t i = 0; i < std::min<std::size_t>(50, tree.hypotheses.size()); ++i) {
    const Hypothesis& h = tree.hypotheses[i];
    EXPECT_NEAR(h.quality, brute_force_quality(local.points, h.map_from_local, 0.1), 0.01);
  }
}

TEST(Ransam, NeighbouringCellsGiveMoreCorrectHypotheses) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const auto correct = [&](bool neighbour_cells) {
    const MatchResult result =
        match({.iterations = 50000, .neighbour_cells = neighbour_cells}, local_map_at(truth, 3.0), 0.7);
    return std::count_if(result.hypotheses.begin(), result.hypotheses.end(), [&](const Hypothesis& h) {
      return distance(h.map_from_local, truth) < 0.3 && rotation_between(h.map_from_local, truth) < 0.2;
    });
  };
  EXPECT_GT(correct(true), 2 * correct(false));
}

TEST(Ransam, WaldsTestFindsThePoseToo) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const MatchResult result =
      match({.iterations = 50000, .extrapolation = "wald"}, local_map_at(truth, 3.0), 0.8);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_LT(distance(result.hypotheses.front().map_from_local, truth), 0.1);  // epsilon
}

TEST(Ransam, AFloodIsMergedWithoutLosingItsPoses) {
  const LocalMap local = local_map_at({2.0, 6.0, -1.0}, 2.5);
  const MatchResult all = match({.iterations = 100000, .max_hypotheses = 1000000}, local, 0.3);
  const MatchResult merged = match({.iterations = 100000, .max_hypotheses = 2000}, local, 0.3);
  ASSERT_GT(all.hypotheses.size(), 4000U);
  EXPECT_LE(merged.hypotheses.size(), 2000U);
  for (const Hypothesis& h : all.hypotheses) {
    ASSERT_TRUE(std::any_of(merged.hypotheses.begin(), merged.hypotheses.end(), [&](const Hypothesis& m) {
      return distance(h.map_from_local, m.map_from_local) < 0.6 &&
             rotation_between(h.map_from_local, m.map_from_local) < 0.3;
    }));
  }
}

/// Three times the small world, 20 m apart. A wall that no scan of ours has seen stands across the second, at
/// x = 6.5 m of it; where the third may have one, cells are unknown.
std::shared_ptr<const GlobalMap> three_rooms() {
  MapData data;
  data.grid = {{-1.0, -1.0, 0.0}, 0.1, 520, 110, PackedCells(std::size_t{520} * 110, Cell::free)};
  for (const double room : {0.0, 20.0, 40.0}) {
    const Points walls = test::moved(test::small_world_points(), {room, 0.0, 0.0});
    for (std::size_t i = 0; i < walls.size(); ++i) data.points.push_back(walls[i]);
  }
  for (int row = 10; row < 60; ++row) {
    data.grid.cell(275, row) = Cell::occupied;
    data.grid.cell(475, row) = Cell::unknown;
  }
  return std::make_shared<const GlobalMap>(std::move(data));
}

/// Seen at x = 5.5 m of a room: three beams of four would pass through the wall.
Observation three_beams_of_four() {
  Observation latest;
  for (const Point& end : {Point{1.9F, 0.0F}, {2.0F, 0.1F}, {2.0F, -0.1F}, {-2.0F, 0.0F}})
    latest.scan.free_ends.push_back(end);
  return latest;
}

const Pose2 in_first_room{5.5, 2.5, 0.0};

MatchResult match_in_three_rooms(double blocked_weight, const Observation& latest, int threads = 1) {
  Ransam ransam({.triples = {.iterations = 100000}, .beams = {.weight = blocked_weight}},
                {three_rooms(), threads});
  Rng rng(1);
  return ransam.match({local_map_at(in_first_room, 3.0), latest, 0.8}, rng);
}

/// How many hypotheses lie at the robot's place in a room, 0 to 2.
std::ptrdiff_t in_room(int room, const MatchResult& result) {
  const Pose2 there{in_first_room.x + 20.0 * room, in_first_room.y, in_first_room.theta};
  return std::count_if(result.hypotheses.begin(), result.hypotheses.end(), [&](const Hypothesis& h) {
    return distance(h.map_from_local, there) < 0.3 && rotation_between(h.map_from_local, there) < 0.1;
  });
}

TEST(Ransam, BeamsThroughAWallLowerTheScore) {
  // Without them, three rooms are as good as each other.
  const MatchResult contact = match_in_three_rooms(0.0, three_beams_of_four());
  for (const int room : {0, 1, 2}) ASSERT_GT(in_room(room, contact), 5);

  // 0.2 times three in four, in the second room only: unknown cells stop no beam.
  const MatchResult weighed = match_in_three_rooms(0.2, three_beams_of_four());
  EXPECT_EQ(weighed.proposals, contact.proposals);
  EXPECT_EQ(in_room(0, weighed), in_room(0, contact));
  EXPECT_EQ(in_room(2, weighed), in_room(2, contact));
  double last = 1.0;
  std::ptrdiff_t less = 0;
  for (const Hypothesis& h : weighed.hypotheses) {
    EXPECT_GE(h.score, 0.8);
    EXPECT_LE(h.score, last);
    last = h.score;
    const auto same =
        std::find_if(contact.hypotheses.begin(), contact.hypotheses.end(),
                     [&](const Hypothesis& other) { return other.map_from_local == h.map_from_local; });
    ASSERT_NE(same, contact.hypotheses.end());
    const bool through_the_wall = h.map_from_local.x > 20.0 && h.map_from_local.x < 30.0;
    EXPECT_NEAR(same->score - h.score, through_the_wall ? 0.15 : 0.0, 1e-12);
    EXPECT_EQ(same->quality, h.quality);
    less += through_the_wall ? 1 : 0;
  }
  // Those that still reach the threshold are left, and no other.
  const auto enough =
      std::count_if(contact.hypotheses.begin(), contact.hypotheses.end(), [](const Hypothesis& h) {
        return h.map_from_local.x > 20.0 && h.map_from_local.x < 30.0 && h.score - 0.15 >= 0.8;
      });
  EXPECT_EQ(less, enough);
  EXPECT_GT(enough, 0);
  EXPECT_LT(enough, in_room(1, contact));

  EXPECT_EQ(in_room(1, match_in_three_rooms(1.0, three_beams_of_four())), 0);
}

void expect_same(const MatchResult& a, const MatchResult& b) {
  EXPECT_EQ(a.points_tested, b.points_tested);
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].map_from_local, b.hypotheses[i].map_from_local);
    EXPECT_EQ(a.hypotheses[i].quality, b.hypotheses[i].quality);
    EXPECT_EQ(a.hypotheses[i].score, b.hypotheses[i].score);
  }
}

TEST(Ransam, BeamsCountOnlyWhereTheyAreAskedFor) {
  const MatchResult contact = match_in_three_rooms(0.0, {});
  expect_same(match_in_three_rooms(0.0, three_beams_of_four()), contact);
  expect_same(match_in_three_rooms(1.0, {}), contact);  // and there are none
  expect_same(match_in_three_rooms(0.2, three_beams_of_four(), 3),
              match_in_three_rooms(0.2, three_beams_of_four(), 1));
}

TEST(Ransam, BeamsOfEarlierStepsCountUntilTheLocalFrameChanges) {
  Ransam ransam({.triples = {.iterations = 100000}, .beams = {.weight = 1.0}}, {three_rooms(), 1});
  LocalMap local = local_map_at(in_first_room, 3.0);
  const auto wrong_room = [&](const Observation& latest) {
    Rng rng(1);
    return in_room(1, ransam.match({local, latest, 0.8}, rng));
  };
  EXPECT_GT(wrong_room({}), 0);
  EXPECT_EQ(wrong_room(three_beams_of_four()), 0);
  EXPECT_EQ(wrong_room({}), 0);
  local.epoch = 1;
  EXPECT_GT(wrong_room({}), 0);
  EXPECT_EQ(wrong_room(three_beams_of_four()), 0);
  ransam.reset();
  EXPECT_GT(wrong_room({}), 0);
}

TEST(Ransam, TooFewPointsGiveNoHypothesis) {
  LocalMap local;
  EXPECT_TRUE(match({}, local, 0.0).hypotheses.empty());
  local.points.push_back({1.0F, 1.0F, 0.0F});
  EXPECT_TRUE(match({}, local, 0.0).hypotheses.empty());
  local.points.push_back({2.0F, 1.0F, 0.0F});
  EXPECT_TRUE(match({}, local, 0.0).hypotheses.empty());
}

}  // namespace
}  // namespace glocal::ransam::ransam_test
