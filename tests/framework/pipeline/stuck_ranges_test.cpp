#include "glocal/stuck_ranges.hpp"

#include <gtest/gtest.h>

namespace glocal::stuck_ranges_test {
namespace {

/// Beams 1 degree apart; those below `stuck` always read 2 m, the others as told.
std::vector<PolarReading> readings(int stuck, double others) {
  std::vector<PolarReading> all;
  for (int i = 0; i < 100; ++i) all.push_back({i < stuck ? 2.0 : others, radians(i - 50.0)});
  return all;
}

TEST(StuckRanges, AreThoseThatStayWhileTheRobotDrivesAndTurns) {
  StuckRanges ranges;
  ranges.take_in(readings(30, 3.0), {});
  ranges.take_in(readings(30, 3.3), {0.6, 0.0, 0.0});
  EXPECT_EQ(ranges.share(), 0.0) << "beside a wall, ranges stay";
  ranges.take_in(readings(30, 3.6), {0.6, 0.0, radians(30.0)});
  EXPECT_DOUBLE_EQ(ranges.share(), 0.3);
}

TEST(StuckRanges, AreNoneOfWhoMovesAlong) {
  StuckRanges ranges;
  for (int i = 0; i < 4; ++i) {
    auto scan = readings(0, 3.0 + 0.1 * i);
    for (int k = 0; k < 60; ++k) scan[static_cast<std::size_t>(k)].range = 0.6;
    ranges.take_in(scan, {0.3 * i, 0.0, radians(15.0 * i)});
  }
  EXPECT_EQ(ranges.share(), 0.0);
}

TEST(StuckRanges, AreNoneWhereTheRobotOnlyTurns) {
  StuckRanges ranges;
  for (int i = 0; i < 36; ++i) ranges.take_in(readings(100, 2.0), {0.0, 0.0, radians(10.0 * i)});
  EXPECT_EQ(ranges.share(), 0.0) << "a round room";
}

TEST(StuckRanges, BeginAnewOnceTheyHaveChanged) {
  StuckRanges ranges;
  ranges.take_in(readings(100, 2.0), {});
  ranges.take_in(readings(40, 2.1), {0.6, 0.0, radians(30.0)});
  EXPECT_DOUBLE_EQ(ranges.share(), 0.4);
  ranges.take_in(readings(0, 2.1), {0.6, 0.0, radians(60.0)});
  EXPECT_EQ(ranges.share(), 0.0);
}

TEST(StuckRanges, OfAScanWithoutHitsAreNone) {
  StuckRanges ranges;
  ranges.take_in({}, {});
  EXPECT_EQ(ranges.share(), 0.0);
}

TEST(StuckRanges, OfASensorThatTouchesAWallAreNoneAtFirst) {
  StuckRanges ranges;
  ranges.take_in({{0.0, 0.0}, {0.0, 1.0}}, {5.0, 5.0, 1.0});
  EXPECT_EQ(ranges.share(), 0.0);
}

}  // namespace
}  // namespace glocal::stuck_ranges_test
