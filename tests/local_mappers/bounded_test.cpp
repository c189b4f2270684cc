#include "local_mappers/bounded.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "local_mappers/drives.hpp"
#include "local_mappers/lone_hits.hpp"

namespace glocal::local_mappers::bounded_test {
namespace {

using test::at;
using test::bad_odometry;
using test::circle;
using test::Drive;
using test::drive;
using ::testing::ElementsAre;

/// Two hits that confirm each other, and make one point.
const std::vector<Point> one_place(2, {1.01F, 0.01F, 0.0F});

/// Points of a map and how many there are after each observation.
struct Thinned {
  std::vector<std::array<double, 2>> points;
  std::vector<std::size_t> ends;
};

/// What hits that do not stand alone make of a map at given poses: the mean of the first three hits in each
/// cell, cells in the order in which they were first hit.
Thinned thin(const std::vector<Observation>& observations, const std::vector<Pose2>& local_from_robot,
             std::size_t first) {
  const PointGrid grid(0.05, 0, 0.1, 1);  // only to name cells as the mapper does
  std::map<std::array<int, 2>, std::size_t> index;
  std::vector<int> hits;
  Thinned result;
  for (std::size_t k = first; k < local_from_robot.size(); ++k) {
    const Transform transform(local_from_robot[k]);
    const std::vector<bool> is_lone = lone_hits(observations[k].scan.hits, observations[k].scan.origin);
    for (std::size_t i = 0; i < observations[k].scan.hits.size(); ++i) {
      if (is_lone[i]) continue;
      const Point p = transform(observations[k].scan.hits[i]);
      const GridCell cell = grid.cell(p.x, p.y);
      const auto [entry, is_new] = index.try_emplace({cell.column, cell.row}, hits.size());
      if (is_new) {
        hits.push_back(0);
        result.points.push_back({0.0, 0.0});
      }
      const std::size_t n = entry->second;
      if (hits[n] == 3) continue;
      result.points[n][0] = (result.points[n][0] * hits[n] + p.x) / (hits[n] + 1);
      result.points[n][1] = (result.points[n][1] * hits[n] + p.y) / (hits[n] + 1);
      ++hits[n];
    }
    result.ends.push_back(hits.size());
  }
  return result;
}

void expect_equal(const LocalMap& map, const Thinned& expected) {
  ASSERT_EQ(map.ends, expected.ends);
  ASSERT_EQ(map.points.size(), expected.points.size());
  for (std::size_t i = 0; i < expected.points.size(); ++i) {
    ASSERT_NEAR(map.points.x[i], expected.points[i][0], 1e-5) << i;
    ASSERT_NEAR(map.points.y[i], expected.points[i][1], 1e-5) << i;
  }
  EXPECT_EQ(map.normals.size(), map.points.size());
}

TEST(Bounded, IsWhatTheLastObservationsAloneWouldGive) {
  const Drive noisy = drive(test::furnished_room(), circle(60), {.noise = 0.02}, bad_odometry);
  Bounded mapper({.scans = 7, .distance = 0.0});
  std::vector<Pose2> poses;
  for (std::size_t k = 0; k < noisy.observations.size(); ++k) {
    mapper.add(noisy.observations[k]);
    poses.push_back(seen_from_above(mapper.map().local_from_robot));
    expect_equal(mapper.map(), thin(noisy.observations, poses, k < 7 ? 0 : k - 6));
    const Pose2 truth = inverse(noisy.map_from_robot.front()) * noisy.map_from_robot[k];
    EXPECT_LT(distance(poses.back(), truth), 0.15);
  }
}

TEST(Bounded, KeepsSoManyMetresOfWay) {
  const Drive exact = drive(test::furnished_room(), circle(40), {}, {});
  Bounded mapper({.scans = 0, .distance = 1.0});
  std::vector<Pose2> poses;
  for (std::size_t k = 0; k < exact.observations.size(); ++k) {
    mapper.add(exact.observations[k]);
    poses.push_back(seen_from_above(mapper.map().local_from_robot));
    // The first observation from which on the way is at most 1 m.
    std::size_t first = k;
    for (double way = 0.0; first > 0; --first) {
      way += distance(poses[first - 1], poses[first]);
      if (way > 1.0) break;
    }
    expect_equal(mapper.map(), thin(exact.observations, poses, first));
  }
  EXPECT_GE(mapper.map().ends.size(), 5U);
  EXPECT_LE(mapper.map().ends.size(), 7U);
}

TEST(Bounded, HitsThatStandAloneAreNotRegistered) {
  Bounded mapper({});
  mapper.add(at(0.0, {{3.01F, 0.01F, 0}, {3.01F, 0.11F, 0}, {1.01F, 0.11F, 0}, {3.01F, 0.21F, 0}}));
  EXPECT_EQ(mapper.map().points.size(), 3U);
  EXPECT_EQ(mapper.map().normals.size(), 3U);
}

/// Points of a map within the box [2, 3] x [-0.5, 0.5] before the robot's first pose.
std::size_t points_in_box(const LocalMap& map) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const bool is_inside =
        map.points.x[i] > 1.9F && map.points.x[i] < 3.1F && std::abs(map.points.y[i]) < 0.6F;
    n += is_inside ? 1U : 0U;
  }
  return n;
}

TEST(Bounded, WhatTwoLaterScansLookThroughIsTakenOut) {
  std::vector<test::Wall> with_box = test::furnished_room();
  const Pose2 first{2.0, 1.5, 0.0};  // The box stands 2 m before it.
  for (const test::Wall& wall : {test::Wall{4, 1, 4, 2}, test::Wall{4, 2, 5, 2}, test::Wall{5, 2, 5, 1}})
    with_box.push_back(wall);
  const std::vector<Pose2> poses = {first, {2.2, 1.5, 0.0}, {2.4, 1.5, 0.0}, {2.6, 1.5, 0.0}};
  const Drive before = drive(with_box, poses, {}, {});
  const Drive after = drive(test::furnished_room(), poses, {}, {});
  Bounded mapper({});
  mapper.add(before.observations[0]);
  const std::size_t box = points_in_box(mapper.map());
  ASSERT_GT(box, 15U);
  mapper.add(after.observations[1]);
  EXPECT_EQ(points_in_box(mapper.map()), box);
  mapper.add(after.observations[2]);
  EXPECT_EQ(points_in_box(mapper.map()), 0U);
  EXPECT_EQ(mapper.map().ends.size(), 3U);

  Bounded still({});  // What is met again stays.
  for (const Observation& observation : before.observations) still.add(observation);
  EXPECT_GE(points_in_box(still.map()), box);
}

TEST(Bounded, WhatMovesAlongIsNotRegistered) {
  const std::vector<Pose2> poses = {{2.0, 1.5, 0.0}, {2.2, 1.5, 0.0}, {2.4, 1.5, 0.0}, {2.6, 1.5, 0.0}};
  Bounded mapper({});
  for (Observation observation : drive(test::furnished_room(), poses, {}, {}).observations) {
    // A mast 0.4 m before the sensor.
    for (std::size_t i = 160; i < 200; ++i)
      observation.scan.hits.set(i, {0.4F, 0.005F * (static_cast<float>(i) - 180.0F), 0.0F});
    mapper.add(observation);
  }
  EXPECT_NEAR(mapper.map().local_from_robot.x, 0.6, 0.02);
  const LocalMap& map = mapper.map();
  for (std::size_t i = map.ends.front(); i < map.points.size(); ++i)
    EXPECT_GT(std::hypot(map.points.x[i], map.points.y[i]), 1.2F) << i;
}

TEST(Bounded, TheStricterLimitHolds) {
  Bounded mapper({.scans = 3, .distance = 1.5});
  for (int k = 0; k < 6; ++k) mapper.add(at(0.1 * k, one_place));
  EXPECT_EQ(mapper.map().ends.size(), 3U);
  mapper.add(at(1.95, one_place));  // 1.45 m farther
  EXPECT_EQ(mapper.map().ends.size(), 2U);
}

TEST(Bounded, IsScanMatchingWhileNothingFallsOut) {
  const Drive exact = drive(test::furnished_room(), circle(40), {}, {});
  Bounded bounded({.scans = 40, .distance = 0.0});
  ScanMatching all({});
  for (Observation observation : exact.observations) {
    const Points hits = observation.scan.hits;
    const std::vector<bool> is_lone = lone_hits(hits, observation.scan.origin);
    observation.scan.hits = {};
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!is_lone[i]) observation.scan.hits.push_back(hits[i]);
    }
    bounded.add(observation);
    all.add(observation);
  }
  EXPECT_EQ(bounded.map().points, all.map().points);
  EXPECT_EQ(bounded.map().normals, all.map().normals);
  EXPECT_EQ(bounded.map().ends, all.map().ends);
  EXPECT_EQ(bounded.map().local_from_robot, all.map().local_from_robot);
}

TEST(Bounded, WhatIsStillSeenStays) {
  const Drive exact = drive(test::furnished_room(), circle(1), {}, {});
  Bounded mapper({.scans = 3, .distance = 0.0});
  mapper.add(exact.observations.front());
  const std::size_t points = mapper.map().points.size();
  ASSERT_GT(points, 100U);
  for (int i = 0; i < 8; ++i) mapper.add(exact.observations.front());
  // Apart from cells at whose borders a hit falls to one side and then to the other.
  ASSERT_EQ(mapper.map().ends.size(), 3U);
  EXPECT_NEAR(static_cast<double>(mapper.map().ends.front()), static_cast<double>(points), 10.0);
}

TEST(Bounded, ObservationsWithoutHitsCountToo) {
  Bounded mapper({.scans = 2, .distance = 0.0});
  mapper.add(at(0.0, one_place));
  mapper.add(at(1.0, {}));
  EXPECT_THAT(mapper.map().ends, ElementsAre(1U, 1U));
  mapper.add(at(2.0, {}));
  EXPECT_THAT(mapper.map().ends, ElementsAre(0U, 0U));
  EXPECT_NEAR(mapper.map().local_from_robot.x, 2.0, 1e-12);
  mapper.add(at(3.0, one_place));
  EXPECT_THAT(mapper.map().ends, ElementsAre(0U, 1U));
  EXPECT_NEAR(mapper.map().points.x[0], 4.01F, 1e-5F);
  EXPECT_EQ(mapper.map().epoch, 0);
}

TEST(Bounded, ForgetsTheWindowWithTheMap) {
  Bounded mapper({.scans = 100, .distance = 0.0});
  for (const Observation& observation : test::kidnapping().observations) mapper.add(observation);
  // Ten observations, one that does not fit, and a new map from the second of those on.
  EXPECT_EQ(mapper.map().epoch, 1);
  EXPECT_EQ(mapper.map().ends.size(), 3U);
  mapper.reset();
  mapper.add(at(5.0, one_place));
  EXPECT_EQ(mapper.map().epoch, 0);
  EXPECT_THAT(mapper.map().ends, ElementsAre(1U));
}

TEST(Bounded, DoesNotGrowWithTheDrive) {
  std::vector<Pose2> poses;
  for (int i = 0; i < 400; ++i) poses.push_back({0.25 * i - 60.0, 0.0, 0.0});
  const Drive corridor =
      drive(test::bare_corridor(), poses, {.beams = 61, .max_range = 8.0, .noise = 0.01}, {});
  Bounded mapper({.scans = 20, .distance = 0.0});
  std::size_t early = 0;
  std::size_t late = 0;
  for (std::size_t k = 0; k < corridor.observations.size(); ++k) {
    mapper.add(corridor.observations[k]);
    if (k >= 20 && k < 60) early = std::max(early, mapper.map().points.size());
    if (k >= 360) late = std::max(late, mapper.map().points.size());
  }
  EXPECT_EQ(mapper.map().ends.size(), 20U);
  // 5 m of way and 8 m of sight to both ends are 21 m, in tiles of 3.2 m, on a strip that touches two or
  // three.
  EXPECT_LE(mapper.grid().tiles(), 3U * 8U);
  EXPECT_LT(static_cast<double>(late), 1.1 * static_cast<double>(early));
}

}  // namespace
}  // namespace glocal::local_mappers::bounded_test
