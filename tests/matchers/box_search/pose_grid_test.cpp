#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glocal/rng.hpp"
#include "matchers/box_search/pose_boxes.hpp"
#include "points.hpp"

namespace glocal::pose_grid_test {
namespace {

Points random_points(Rng& rng, std::size_t n) {
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    points.push_back(
        {static_cast<float>(rng.uniform(-1.0, 6.0)), static_cast<float>(rng.uniform(2.0, 5.0)), 0.0F});
  }
  return points;
}

TEST(PoseGrid, APoseBringsEachPointIntoItsCell) {
  Rng rng(1);
  const Points points = random_points(rng, 20);
  const PoseGrid grid(points, {.cell = 0.1, .min_x = 40.0, .min_y = -8.0}, 0.001);
  for (const std::size_t rotation : {std::size_t{0}, grid.rotations(0) / 3, grid.rotations(0) - 1}) {
    const CellPoints cells = grid.cells(0, rotation).front();
    const Pose2 pose = grid.pose(0, rotation, 17, -5);
    ASSERT_EQ(cells.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Pose2 at = pose * Pose2{points.x[i], points.y[i], 0.0};
      EXPECT_NEAR((at.x - 40.0) / 0.1, cells.columns()[i] + 17 + 0.5, 0.5 + 1e-6);
      EXPECT_NEAR((at.y + 8.0) / 0.1, cells.rows()[i] - 5 + 0.5, 0.5 + 1e-6);
    }
  }
}

TEST(PoseGrid, AStepOfRotationMovesTheFarthestPointByACell) {
  // The middle is (3, 0), the farthest points 5 m from it.
  const Points points =
      test::points_of({{-2.0F, 0.0F, 0.0F}, {8.0F, 0.0F, 0.0F}, {3.0F, 1.0F, 0.0F}, {3.0F, -1.0F, 0.0F}});
  const CellFrame frame{.cell = 0.05};
  const PoseGrid grid(points, frame, 0.001);
  EXPECT_EQ(grid.rotations(0), static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / 0.01)));
  EXPECT_NEAR(grid.angle(0, 1), 0.01, 1e-4);
  // Not smaller than asked for, and never larger than 0.1 rad.
  EXPECT_EQ(PoseGrid(points, frame, 0.02).rotations(0), 315U);
  const Points one = test::points_of({{100.0F, 7.0F, 0.0F}});
  EXPECT_EQ(PoseGrid(one, frame, 0.001).rotations(0), 63U);
}

}  // namespace
}  // namespace glocal::pose_grid_test
