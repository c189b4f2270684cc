#include "matchers/common/beam_evidence.hpp"

#include <gtest/gtest.h>

namespace glocal::beam_evidence_test {
namespace {

/// 4 m x 4 m of free cells with an occupied column from x = 2 to 2.1 m, and unknown ones from x = 3 m on.
ClearanceGrid grid_with_a_wall() {
  OccupancyGrid grid{{0.0, 0.0, 0.0}, 0.1, 40, 40, PackedCells(1600, Cell::free)};
  for (int row = 0; row < 40; ++row) {
    grid.cell(20, row) = Cell::occupied;
    for (int column = 30; column < 40; ++column) grid.cell(column, row) = Cell::unknown;
  }
  return ClearanceGrid(grid);
}

Scan beams_along_x(const std::vector<float>& ranges) {
  Scan scan;
  for (const float range : ranges) scan.hits.push_back({range, 0.0F, 0.0F});
  return scan;
}

double blocked(const Scan& scan, const Pose2& map_from_local, const BeamRule& rule = {}) {
  BeamEvidence evidence(rule);
  LocalMap local;
  evidence.add(local, scan);
  return evidence.blocked_share(grid_with_a_wall(), map_from_local);
}

TEST(BeamEvidence, CountsBeamsThatPassThroughAWall) {
  // From x = 1 m: 0.9 m ends before the wall, 1.2 m within the margin behind it, 1.5 m and more do not.
  EXPECT_EQ(blocked(beams_along_x({0.9F}), {1.0, 1.0, 0.0}), 0.0);
  EXPECT_EQ(blocked(beams_along_x({1.2F}), {1.0, 1.0, 0.0}), 0.0);
  EXPECT_EQ(blocked(beams_along_x({1.5F}), {1.0, 1.0, 0.0}), 1.0);
  EXPECT_EQ(blocked(beams_along_x({0.9F, 1.5F, 1.2F, 1.8F}), {1.0, 1.0, 0.0}), 0.5);
  // The other way there is no wall; nor in unknown cells, nor beyond the grid.
  EXPECT_EQ(blocked(beams_along_x({0.9F, 5.0F}), {1.0, 1.0, 3.14159}), 0.0);
  EXPECT_EQ(blocked(beams_along_x({5.0F}), {2.5, 1.0, 0.0}), 0.0);
}

TEST(BeamEvidence, FreeRaysCountToo) {
  Scan scan;
  scan.free_ends.push_back({1.8F, 0.0F, 0.0F});
  EXPECT_EQ(blocked(scan, {1.0, 1.0, 0.0}), 1.0);
  EXPECT_EQ(blocked({}, {1.0, 1.0, 0.0}), 0.0);
}

TEST(BeamEvidence, BeamsBeginAtTheSensorWhereTheRobotWas) {
  BeamEvidence evidence(BeamRule{});
  LocalMap local;
  local.local_from_robot = Pose2{0.5, 0.0, 0.0};
  Scan scan = beams_along_x({1.2F});
  scan.origin = {0.2F, 0.0F, 0.0F};
  evidence.add(local, scan);
  // Sensor at 1.7 m, hit at 2.7 m: through the wall. With the local map half a metre back: 2.2 m, within the
  // margin.
  EXPECT_EQ(evidence.blocked_share(grid_with_a_wall(), {1.0, 1.0, 0.0}), 1.0);
  EXPECT_EQ(evidence.blocked_share(grid_with_a_wall(), {0.5, 1.0, 0.0}), 0.0);
}

TEST(BeamEvidence, OnlyTheLatestScansOfThisLocalMapCount) {
  BeamEvidence evidence({.scans = 2});
  LocalMap local;
  const ClearanceGrid grid = grid_with_a_wall();
  const Pose2 pose{1.0, 1.0, 0.0};
  evidence.add(local, beams_along_x({1.8F}));
  evidence.add(local, beams_along_x({0.5F}));
  EXPECT_EQ(evidence.blocked_share(grid, pose), 0.5);
  evidence.add(local, beams_along_x({0.5F}));
  EXPECT_EQ(evidence.blocked_share(grid, pose), 0.0);
  evidence.add(local, beams_along_x({1.8F}));
  local.epoch = 1;
  evidence.add(local, beams_along_x({0.5F}));
  EXPECT_EQ(evidence.blocked_share(grid, pose), 0.0);
}

TEST(BeamEvidence, AScanWithoutABeamLeavesWhatOthersSaid) {
  BeamEvidence evidence({.scans = 2});
  const LocalMap local;
  evidence.add(local, beams_along_x({1.8F}));
  for (int i = 0; i < 3; ++i) evidence.add(local, {});
  EXPECT_EQ(evidence.blocked_share(grid_with_a_wall(), {1.0, 1.0, 0.0}), 1.0);
}

TEST(BeamEvidence, ManyBeamsAreThinnedEvenly) {
  std::vector<float> ranges(1000, 0.5F);
  std::fill(ranges.begin(), ranges.begin() + 500, 1.8F);
  EXPECT_NEAR(blocked(beams_along_x(ranges), {1.0, 1.0, 0.0}, {.beams = 40}), 0.5, 1e-9);
}

TEST(BeamEvidence, StopsEarlyOnlyAboveWhatIsAskedFor) {
  BeamEvidence evidence(BeamRule{});
  LocalMap local;
  std::vector<float> ranges(20, 0.5F);  // no wall before the margin …
  std::fill(ranges.begin(), ranges.begin() + 10, 1.8F);
  evidence.add(local, beams_along_x(ranges));
  evidence.add(local, beams_along_x(ranges));
  const auto share = [&](double most) {
    return evidence.blocked_share(grid_with_a_wall(), {1.0, 1.0, 0.0}, most);
  };
  for (const double most : {0.5, 0.6, 1.0}) EXPECT_EQ(share(most), 0.5);  // … for one half
  for (const double most : {-0.2, 0.0, 0.1, 0.4}) EXPECT_GT(share(most), most);
  for (const double most : {-0.2, 0.0, 0.1}) EXPECT_EQ(share(most), 0.25);  // the first scan is enough
}

TEST(BeamEvidence, ThePenaltyIsTheWeightedShareUpToTheCap) {
  const auto penalty = [](const BeamRule& rule) {
    BeamEvidence evidence(rule);
    evidence.add({}, beams_along_x({1.8F, 0.5F}));  // one of two goes through the wall
    return evidence.penalty(grid_with_a_wall(), {1.0, 1.0, 0.0});
  };
  EXPECT_DOUBLE_EQ(penalty({.weight = 0.8}), 0.4);
  EXPECT_DOUBLE_EQ(penalty({.weight = 0.8, .cap = 0.5}), 0.4);
  EXPECT_DOUBLE_EQ(penalty({.weight = 0.8, .cap = 0.25}), 0.2);
  EXPECT_EQ(penalty({.weight = 0.0}), 0.0);
}

TEST(BeamEvidence, WhatEndsAtTheWallSupportsAndWhatGoesThroughItSpeaksAgainst) {
  Points wall;
  for (int row = 0; row < 40; ++row) wall.push_back({2.05F, 0.05F + 0.1F * static_cast<float>(row), 0.0F});
  const BitsetContact contact(wall, 0.1);
  const ClearanceGrid grid = grid_with_a_wall();
  const Pose2 pose{1.0, 1.05, 0.0};
  // Ten of thirty beams end at the wall, ten before it, ten well behind it.
  std::vector<float> ranges(30, 1.05F);
  std::fill(ranges.begin() + 10, ranges.begin() + 20, 0.5F);
  std::fill(ranges.begin() + 20, ranges.end(), 1.9F);
  BeamEvidence evidence(BeamRule{});
  LocalMap local;
  evidence.add(local, beams_along_x(ranges));
  EXPECT_NEAR(evidence.support(contact, grid, pose), (10.0 - 2.0 * 10.0) / 30.0, 1e-12);

  // Ten beams alone are a third of a scan. Made where the last one was made, they take its place; those
  // before are of places of their own.
  const Scan ten = beams_along_x(std::vector<float>(10, 1.05F));
  for (int i = 0; i < 4; ++i) evidence.add(local, ten);
  EXPECT_NEAR(evidence.support(contact, grid, pose), (10.0 - 2.0 * 10.0) / 30.0 + 10.0 / 30.0, 1e-12);
  // 0.6 m to the side, from where the wall is as far, is another place; with the next one both are kept.
  for (const double aside : {0.6, 1.2}) {
    local.local_from_robot = Pose2{0.0, aside, 0.0};
    evidence.add(local, ten);
  }
  EXPECT_NEAR(evidence.support(contact, grid, pose), (10.0 - 2.0 * 10.0) / 30.0 + 20.0 / 30.0, 1e-12);
  // A ray that met nothing cannot have passed through the wall, and ends at nothing.
  Scan free;
  free.free_ends.push_back({1.05F, 0.0F, 0.0F});
  free.free_ends.push_back({1.9F, 0.0F, 0.0F});
  BeamEvidence of_rays(BeamRule{});
  of_rays.add({}, free);
  EXPECT_NEAR(of_rays.support(contact, grid, pose), -2.0 / 30.0, 1e-12);
}

}  // namespace
}  // namespace glocal::beam_evidence_test
