// Eq. 10 on a map of four points, a metre apart.
#include "glocal/unknown_place.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

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
constexpr Point on{0.0F, 2.0F, 0.0F};
constexpr Point off{1.0F, 0.0F, 0.0F};

/// A local map whose observations registered these points.
LocalMap observed(const std::vector<std::vector<Point>>& observations) {
  LocalMap local;
  for (const std::vector<Point>& points : observations) {
    for (const Point& point : points) local.points.push_back(point);
    local.ends.push_back(local.points.size());
  }
  return local;
}

double omega_place(int window, const LocalMap& local) {
  UnknownPlaceMonitor monitor({.window = window, .contact_epsilon = 0.1}, four_points(), 1.0);
  return monitor.update(local, {{pose, {}, 0.9}}).value_or(-1.0);
}

TEST(UnknownPlace, IsTheMeanOfTheSharesOfTheObservations) {
  // 1 of 4, 2 of 2, 0 of 1: every observation counts the same, however many points it has.
  const LocalMap local = observed({{on, off, off, off}, {on, on}, {off}});
  EXPECT_DOUBLE_EQ(omega_place(10, local), (0.25 + 1.0 + 0.0) / 3.0);
}

TEST(UnknownPlace, LooksBackAsFarAsTheWindow) {
  const LocalMap local = observed({{on, off, off, off}, {on, on}, {off}});
  EXPECT_DOUBLE_EQ(omega_place(3, local), 1.25 / 3.0);
  EXPECT_DOUBLE_EQ(omega_place(2, local), 0.5);
  EXPECT_DOUBLE_EQ(omega_place(1, local), 0.0);
}

TEST(UnknownPlace, ObservationsWithoutPointsDoNotCount) {
  EXPECT_DOUBLE_EQ(omega_place(2, observed({{off}, {on, off}, {}, {on}, {}, {}})), 0.75);
  EXPECT_DOUBLE_EQ(omega_place(10, observed({{}, {on}, {}})), 1.0);
  EXPECT_DOUBLE_EQ(omega_place(10, observed({{}, {}})), -1.0);
}

TEST(UnknownPlace, IsJudgedByTheBestHypothesis) {
  const auto map = four_points();
  UnknownPlaceMonitor monitor({}, map, 0.1);
  const LocalMap local = observed({{{0.0F, 0.0F, 0.0F}, {0.0F, 3.0F, 0.0F}}});
  // Turned by a quarter both points are met, unturned one of them is.
  EXPECT_EQ(monitor.update(local, {{pose, {}, 0.9}, {{}, {}, 0.9}}), 1.0);
  EXPECT_EQ(monitor.update(local, {{{}, {}, 0.9}, {pose, {}, 0.9}}), 0.5);
}

TEST(UnknownPlace, PosesInSpaceMoveThePointsInSpace) {
  const auto map = four_points();
  UnknownPlaceMonitor monitor({}, map, 0.1);
  // The robot lies on its left side, 2 m above: what is 2 m to its right is below it.
  const Pose3 on_its_side({1.0, 0.0, 2.0}, exponential({-std::numbers::pi / 2.0, 0.0, 0.0}));
  const LocalMap local = observed({{{0.0F, 2.0F, 0.0F}, {1.0F, 2.0F, 0.0F}, {0.0F, 0.0F, 2.0F}}});
  EXPECT_DOUBLE_EQ(monitor.update(local, {{on_its_side, {}, 0.9}}).value(), 2.0 / 3.0);
  EXPECT_EQ(monitor.update(local, {{{}, {}, 0.9}}), 0.0);
}

TEST(UnknownPlace, AStepWithoutHypothesesIsJudgedByTheLastBest) {
  const auto map = four_points();
  UnknownPlaceMonitor monitor({}, map, 0.1);
  EXPECT_EQ(monitor.update(observed({{on}}), {}), std::nullopt);
  EXPECT_EQ(monitor.update(observed({{on}}), {{pose, {}, 0.9}}), 1.0);
  EXPECT_EQ(monitor.update(observed({{on}, {off}}), {}), 0.5);
  EXPECT_EQ(monitor.update(observed({{on}, {off}, {off}, {off}}), {}), 0.25);
}

TEST(UnknownPlace, APoseInTheFrameOfAnEarlierLocalMapMeansNothing) {
  const auto map = four_points();
  UnknownPlaceMonitor monitor({}, map, 0.1);
  LocalMap local = observed({{on}});
  EXPECT_EQ(monitor.update(local, {{pose, {}, 0.9}}), 1.0);
  local.epoch = 1;
  EXPECT_EQ(monitor.update(local, {}), std::nullopt);
  EXPECT_EQ(monitor.update(local, {{{}, {}, 0.9}}), 0.0);
  EXPECT_EQ(monitor.update(local, {}), 0.0);
}

TEST(UnknownPlace, ForgetsTheBestWhenReset) {
  const auto map = four_points();
  UnknownPlaceMonitor monitor({}, map, 0.1);
  EXPECT_EQ(monitor.update(observed({{on}}), {{pose, {}, 0.9}}), 1.0);
  monitor.reset();
  EXPECT_EQ(monitor.update(observed({{on}}), {}), std::nullopt);
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
