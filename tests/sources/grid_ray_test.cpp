#include "sources/grid_ray.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

namespace glocal::grid_ray_test {
namespace {

using Cells = std::vector<std::pair<int, int>>;

Cells cells_before_end(double x0, double y0, double x1, double y1) {
  Cells cells;
  visit_cells_before_end(x0, y0, x1, y1, [&](int column, int row, double /*share*/) {
    cells.emplace_back(column, row);
    return true;
  });
  return cells;
}

TEST(GridRay, VisitsTheCellsOfALineInOrder) {
  // The line reaches y = 1 at x = 0.5 + 3 * 0.5 / 1.1 = 1.86.
  EXPECT_EQ(cells_before_end(0.5, 0.5, 3.5, 1.6), (Cells{{0, 0}, {1, 0}, {1, 1}, {2, 1}}));
  EXPECT_EQ(cells_before_end(1.5, 2.5, 1.5, -0.5), (Cells{{1, 2}, {1, 1}, {1, 0}}));
  EXPECT_TRUE(cells_before_end(1.2, 1.2, 1.8, 1.8).empty());
}

TEST(GridRay, VisitsVoxelsInSpaceInOrder) {
  std::vector<std::array<int, 3>> voxels;
  std::vector<double> shares;
  // Borders at z = 1 after a third, x = 1 after a half, y = 1 after three quarters of the line.
  visit_cells_before_end<3>({0.5, 0.25, 0.5}, {1.5, 1.25, 2.0},
                            [&](const std::array<int, 3>& voxel, double share) {
                              voxels.push_back(voxel);
                              shares.push_back(share);
                              return voxels.size() < 4;
                            });
  EXPECT_EQ(voxels, (std::vector<std::array<int, 3>>{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}}));
  ASSERT_EQ(shares.size(), 4U);
  EXPECT_NEAR(shares[1], 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(shares[2], 0.5, 1e-12);
  EXPECT_NEAR(shares[3], 0.75, 1e-12);
}

TEST(GridRay, TellsWhereTheLineEntersACell) {
  std::vector<double> shares;
  visit_cells_before_end(0.5, 0.5, 3.5, 1.6, [&](int /*column*/, int /*row*/, double share) {
    shares.push_back(share);
    return true;
  });
  // Borders at x = 1, y = 1, x = 2; the line is 3 long in x and 1.1 in y.
  ASSERT_EQ(shares.size(), 4U);
  EXPECT_EQ(shares[0], 0.0);
  EXPECT_NEAR(shares[1], 0.5 / 3.0, 1e-12);
  EXPECT_NEAR(shares[2], 0.5 / 1.1, 1e-12);
  EXPECT_NEAR(shares[3], 1.5 / 3.0, 1e-12);
}

TEST(GridRay, StopsWhereItIsToldTo) {
  Cells cells;
  visit_cells_before_end(0.5, 0.5, 9.5, 0.5, [&](int column, int row, double /*share*/) {
    cells.emplace_back(column, row);
    return column < 2;
  });
  EXPECT_EQ(cells, (Cells{{0, 0}, {1, 0}, {2, 0}}));
}

}  // namespace
}  // namespace glocal::grid_ray_test
