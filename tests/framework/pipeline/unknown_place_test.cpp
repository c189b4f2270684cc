// Eq. 10 on a map of four points, a metre apart.
#include "glocal/unknown_place.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "points.hpp"

namespace glocal::test::unknown_place_test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

std::shared_ptr<const GlobalMap> four_points() {
  MapData data;
  for (int i = 0; i < 4; ++i) data.points.push_back({static_cast<float>(i), 0.0F, 0.0F});
  return std::make_shared<const GlobalMap>(std::move(data));
}

/// On this map under `pose`: (0, 0), (0, 1), (0, 2) and (0, 3); nothing else is.
const Pose2 pose{3.0, 0.0, std::numbers::pi / 2.0};

/// So many that are on the map, up to 4, and others that are off it.
std::vector<Point> hits(int on, int off) {
  std::vector<Point> all;
  for (int i = 0; i < on; ++i) all.push_back({0.0F, static_cast<float>(i), 0.0F});
  for (int i = 0; i < off; ++i) all.push_back({static_cast<float>(1 + i), 0.0F, 0.0F});
  return all;
}

/// Nothing has moved since the local map was begun.
std::optional<double> update(UnknownPlaceMonitor& monitor, const std::vector<Point>& scan,
                             const std::vector<Hypothesis>& hypotheses) {
  return monitor.update({}, points_of(scan), hypotheses);
}

/// After these scans.
double omega_place(int window, const std::vector<std::vector<Point>>& scans) {
  UnknownPlaceMonitor monitor({.window = window, .contact_epsilon = 0.1}, four_points(), 1.0);
  std::optional<double> result;
  for (const std::vector<Point>& scan : scans) result = update(monitor, scan, {{pose, {}, 0.9}});
  return result.value_or(-1.0);
}

TEST(UnknownPlace, IsTheMeanOfTheSharesOfTheScans) {
  // 1 of 4, 2 of 2, 0 of 1: every scan counts the same, however many hits it has.
  EXPECT_DOUBLE_EQ(omega_place(10, {hits(1, 3), hits(2, 0), hits(0, 1)}), (0.25 + 1.0 + 0.0) / 3.0);
}

TEST(UnknownPlace, LooksBackAsFarAsTheWindow) {
  const std::vector<std::vector<Point>> scans = {hits(1, 3), hits(2, 0), hits(0, 1)};
  EXPECT_DOUBLE_EQ(omega_place(3, scans), 1.25 / 3.0);
  EXPECT_DOUBLE_EQ(omega_place(2, scans), 0.5);
  EXPECT_DOUBLE_EQ(omega_place(1, scans), 0.0);
}

TEST(UnknownPlace, ScansWithoutHitsDoNotCount) {
  EXPECT_DOUBLE_EQ(omega_place(2, {hits(0, 1), hits(1, 1), {}, hits(1, 0), {}, {}}), 0.75);
  EXPECT_DOUBLE_EQ(omega_place(10, {{}, hits(1, 0), {}}), 1.0);
  EXPECT_DOUBLE_EQ(omega_place(10, {{}, {}}), -1.0);
}

TEST(UnknownPlace, WhatTheLocalMapHadBeforeCountsInEachScan) {
  // A robot that stands still adds nothing to its local map but who walks by.
  UnknownPlaceMonitor monitor({}, four_points(), 0.1);
  LocalMap local;
  local.points = points_of(hits(3, 0));
  local.ends = {3};
  EXPECT_EQ(monitor.update(local, points_of(hits(3, 0)), {{pose, {}, 0.9}}), 1.0);
  local.points.push_back({1.0F, 0.0F, 0.0F});
  local.ends = {3, 4};
  EXPECT_DOUBLE_EQ(monitor.update(local, points_of(hits(3, 1)), {{pose, {}, 0.9}}).value(), 0.875);
}

TEST(UnknownPlace, WhatIsNearIsNotMostOfWhatIsSeen) {
  // A hundred hits on the 0.4 m of somebody beside the robot are five of those that are 0.1 m apart.
  UnknownPlaceMonitor monitor({}, four_points(), 0.1);
  std::vector<Point> scan = hits(4, 0);
  for (int i = 0; i <= 100; ++i) scan.push_back({0.52F, 0.05F + 0.004F * static_cast<float>(i), 0.0F});
  EXPECT_DOUBLE_EQ(update(monitor, scan, {{pose, {}, 0.9}}).value(), 4.0 / 9.0);
}

TEST(UnknownPlace, EachScanStaysWhereTheRobotWas) {
  UnknownPlaceMonitor monitor({}, four_points(), 0.1);
  LocalMap local;
  // (0, 1) on the map each time: 1 m ahead of where the robot was first, at its side when it has turned
  // there.
  EXPECT_EQ(monitor.update(local, points_of({{1.0F, 0.0F, 0.0F}}), {{Pose3{}, {}, 0.9}}), 1.0);
  local.local_from_robot = Pose2{1.0, 1.0, std::numbers::pi / 2.0};
  EXPECT_EQ(monitor.update(local, points_of({{-1.0F, 0.0F, 0.0F}}), {{Pose3{}, {}, 0.9}}), 1.0);
  EXPECT_EQ(monitor.update(local, points_of({{0.0F, 5.0F, 0.0F}}), {{Pose3{}, {}, 0.9}}), 2.0 / 3.0);
}

TEST(UnknownPlace, IsJudgedByTheBestHypothesis) {
  const std::vector<Point> scan = {{0.0F, 0.0F, 0.0F}, {0.0F, 3.0F, 0.0F}};
  // Turned by a quarter both points are met, unturned one of them is.
  UnknownPlaceMonitor turned({}, four_points(), 0.1);
  EXPECT_EQ(update(turned, scan, {{pose, {}, 0.9}, {{}, {}, 0.9}}), 1.0);
  UnknownPlaceMonitor unturned({}, four_points(), 0.1);
  EXPECT_EQ(update(unturned, scan, {{{}, {}, 0.9}, {pose, {}, 0.9}}), 0.5);
  // The best of now judges the scans before, too.
  EXPECT_EQ(update(unturned, {}, {{pose, {}, 0.9}}), 1.0);
}

TEST(UnknownPlace, PosesInSpaceMoveThePointsInSpace) {
  UnknownPlaceMonitor monitor({}, four_points(), 0.1);
  // The robot lies on its left side, 2 m above: what is 2 m to its right is below it.
  const Pose3 on_its_side({1.0, 0.0, 2.0}, exponential({-std::numbers::pi / 2.0, 0.0, 0.0}));
  const std::vector<Point> scan = {{0.0F, 2.0F, 0.0F}, {1.0F, 2.0F, 0.0F}, {0.0F, 0.0F, 2.0F}};
  EXPECT_DOUBLE_EQ(update(monitor, scan, {{on_its_side, {}, 0.9}}).value(), 2.0 / 3.0);
  EXPECT_EQ(update(monitor, {}, {{Pose2{0.0, 0.0, 0.0}, {}, 0.9}}), 0.0);
}

TEST(UnknownPlace, AStepWithoutHypothesesIsJudgedByTheLastBest) {
  UnknownPlaceMonitor monitor({}, four_points(), 0.1);
  EXPECT_EQ(update(monitor, hits(1, 0), {}), std::nullopt);
  EXPECT_EQ(update(monitor, hits(1, 0), {{pose, {}, 0.9}}), 1.0);
  EXPECT_EQ(update(monitor, hits(0, 2), {}), 2.0 / 3.0);
  EXPECT_EQ(update(monitor, hits(0, 1), {}), 0.5);
}

TEST(UnknownPlace, WhatIsInTheFrameOfAnEarlierLocalMapMeansNothing) {
  UnknownPlaceMonitor monitor({}, four_points(), 0.1);
  LocalMap local;
  EXPECT_EQ(monitor.update(local, points_of(hits(1, 0)), {{pose, {}, 0.9}}), 1.0);
  local.epoch = 1;
  EXPECT_EQ(monitor.update(local, points_of(hits(0, 1)), {}), std::nullopt);
  EXPECT_EQ(monitor.update(local, {}, {{pose, {}, 0.9}}), 0.0) << "the scan before is forgotten, too";
}

TEST(UnknownPlace, ForgetsAllWhenReset) {
  UnknownPlaceMonitor monitor({}, four_points(), 0.1);
  EXPECT_EQ(update(monitor, hits(1, 0), {{pose, {}, 0.9}}), 1.0);
  monitor.reset();
  EXPECT_EQ(update(monitor, hits(0, 1), {}), std::nullopt);
  EXPECT_EQ(update(monitor, {}, {{pose, {}, 0.9}}), 0.0);
}

TEST(UnknownPlace, IsUnknownBelowTheLimitOnly) {
  const auto map = four_points();
  const UnknownPlaceMonitor monitor({.max_contact = 0.2}, map, 0.1);
  EXPECT_FALSE(monitor.is_unknown(std::nullopt));
  EXPECT_TRUE(monitor.is_unknown(0.0));
  EXPECT_TRUE(monitor.is_unknown(0.199));
  EXPECT_FALSE(monitor.is_unknown(0.2));
  const UnknownPlaceMonitor off_switched({.max_contact = 0.0}, map, 0.1);
  EXPECT_FALSE(off_switched.is_unknown(0.0));
}

TEST(UnknownPlace, AHitIsOnTheMapUnmappedBeyondItOrUnknown) {
  MapData data;
  data.points.push_back({0.5F, 0.5F, 0.0F});
  data.grid = {{}, 1.0, 4, 1, {Cell::occupied, Cell::free, Cell::unknown, Cell::free}};
  const UnknownPlaceMonitor monitor({}, std::make_shared<const GlobalMap>(std::move(data)), 0.1);
  Scan scan;
  scan.origin = {1.6F, 0.5F, 0.0F};
  scan.hits.push_back({0.5F, 0.52F, 0.0F});  // in contact
  scan.hits.push_back({1.5F, 0.5F, 0.0F});   // in a free cell
  scan.hits.push_back({0.9F, 0.5F, 0.0F});   // in an occupied cell, too far from its centre
  scan.hits.push_back({2.5F, 0.5F, 0.0F});   // in an unknown cell
  scan.hits.push_back({0.5F, 3.0F, 0.0F});   // off the grid
  using enum HitKind;
  EXPECT_THAT(monitor.kinds_of(scan, {}), ElementsAre(on_map, unmapped, unmapped, unknown, unknown));
  // From the other side, through the occupied cell.
  scan.origin = {-1.0F, 0.5F, 0.0F};
  EXPECT_THAT(monitor.kinds_of(scan, {}), ElementsAre(on_map, beyond, beyond, unknown, unknown));
  // Turned and moved: (x, y) is at (1 - y, x).
  Scan turned;
  turned.hits.push_back({0.5F, 0.5F, 0.0F});
  EXPECT_THAT(monitor.kinds_of(turned, {1.0, 0.0, std::numbers::pi / 2.0}), ElementsAre(on_map));
  EXPECT_THAT(monitor.kinds_of(scan, {10.0, 10.0, 0.0}), Each(unknown));
  EXPECT_THAT(UnknownPlaceMonitor({}, four_points(), 0.1).kinds_of(scan, {}), Each(unknown));
}

}  // namespace
}  // namespace glocal::test::unknown_place_test
