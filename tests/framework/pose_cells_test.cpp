#include "glocal/pose_cells.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "clustering/poses.hpp"

namespace glocal::pose_cells_test {
namespace {

TEST(PoseCells, VisitsEachCellNearOnce) {
  Rng rng(3);
  std::vector<Pose2> poses;
  for (const Hypothesis& h : test::crowded(500, rng)) poses.push_back(seen_from_above(h.map_from_robot));
  for (const int turns : {1, 2, 3, 4, 5, 36}) {
    const PoseCells cells(poses, {0.1, turns});
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const PoseCell& at = cells.cell(c);
      std::multiset<std::size_t> expected;
      for (std::size_t other = 0; other < cells.size(); ++other) {
        const PoseCell& cell = cells.cell(other);
        const std::int64_t apart = std::abs(cell.turn - at.turn);
        if (std::abs(cell.row - at.row) <= 2 && std::abs(cell.column - at.column) <= 2 &&
            std::min(apart, turns - apart) <= 2) {
          expected.insert(other);
        }
      }
      std::multiset<std::size_t> visited;
      cells.visit_near(at, 2, 2, [&](std::size_t other) {
        visited.insert(other);
        return true;
      });
      ASSERT_EQ(visited, expected) << turns;
    }
  }
}

TEST(PoseCells, HoldEachPoseWhereItBelongs) {
  Rng rng(4);
  std::vector<Pose2> poses;
  for (const Hypothesis& h : test::crowded(300, rng)) poses.push_back(seen_from_above(h.map_from_robot));
  const PoseCells cells(poses, {0.1, 24});
  std::size_t held = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    EXPECT_TRUE(std::is_sorted(cells.members(c).begin(), cells.members(c).end()));
    for (const std::size_t i : cells.members(c)) EXPECT_EQ(cells.cell_of(poses[i]), cells.cell(c));
    held += cells.members(c).size();
  }
  EXPECT_EQ(held, poses.size());
}

TEST(PoseBinning, TheTurnOfACellFollowsOnItselfAndRightAnglesAreInTheMiddle) {
  const PoseBinning binning{0.5, 8};
  const PoseCell south = binning.cell_of({0.1, 0.1, radians(180)});
  EXPECT_EQ(south, (PoseCell{4, 0, 0}));
  for (const double theta_deg : {159.0, 170.0, 179.9, -179.9, -170.0, -159.0})
    EXPECT_EQ(binning.cell_of({0.1, 0.1, radians(theta_deg)}), south) << theta_deg;
  EXPECT_EQ(binning.cell_of({0.1, 0.1, radians(156.0)}).turn, 3);
  EXPECT_EQ(binning.cell_of({0.1, 0.1, radians(-156.0)}).turn, 5);
  EXPECT_EQ(binning.cell_of({0.1, 0.1, radians(-22.0)}).turn, 0);
  EXPECT_EQ(binning.cell_of({-0.1, 1.6, 0.0}), (PoseCell{0, 3, -1}));
}

TEST(PoseCellHash, TellsNeighboursApart) {
  std::set<std::size_t> hashes;
  for (int turn = 0; turn < 10; ++turn) {
    for (int row = -10; row < 10; ++row) {
      for (int column = -10; column < 10; ++column) hashes.insert(PoseCellHash{}({turn, row, column}));
    }
  }
  EXPECT_EQ(hashes.size(), 4000U);
}

TEST(PartsOfATurn, AreNarrowOrWideEnough) {
  EXPECT_EQ(parts_of_a_turn(radians(30)), 12);
  EXPECT_EQ(parts_of_a_turn(radians(29)), 13);
  EXPECT_EQ(parts_of_a_turn(radians(180)), 2);
  EXPECT_EQ(parts_of_a_turn(1e12), 1);
  EXPECT_EQ(square_parts_of_a_turn(radians(30)), 12);
  EXPECT_EQ(square_parts_of_a_turn(radians(29)), 16);
  EXPECT_EQ(square_parts_of_a_turn(radians(400)), 4);
  EXPECT_EQ(wide_parts_of_a_turn(radians(29)), 12);
  EXPECT_EQ(wide_parts_of_a_turn(radians(400)), 1);
}

}  // namespace
}  // namespace glocal::pose_cells_test
