#include "local_mappers/point_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "glocal/rng.hpp"

namespace glocal::local_mappers::point_grid_test {
namespace {

constexpr double resolution = 0.05;
constexpr int reach = 9;
constexpr double sigma = 0.1;
constexpr std::size_t many_tiles = 1000;

struct World {
  PointGrid grid{resolution, reach, sigma, many_tiles};
  std::vector<GridCell> cells;

  /// Points scattered over `size` m around the origin, one per cell at most.
  World(std::size_t n, double size) {
    Rng rng(7);
    while (cells.size() < n) {
      const GridCell cell = grid.cell(static_cast<float>(rng.uniform(-size, size)),
                                      static_cast<float>(rng.uniform(-size, size)));
      if (grid.inside(cell) != PointGrid::none) continue;
      EXPECT_TRUE(grid.insert(cell, cells.size()));
      cells.push_back(cell);
    }
  }

  /// The nearest point within reach in columns and rows, the earlier of two: by looking at all of them.
  [[nodiscard]] int brute_force(GridCell at) const {
    int best = PointGrid::none;
    int best_squared = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const int dx = cells[i].column - at.column;
      const int dy = cells[i].row - at.row;
      if (std::abs(dx) > reach || std::abs(dy) > reach || dx * dx + dy * dy >= best_squared) continue;
      best = static_cast<int>(i);
      best_squared = dx * dx + dy * dy;
    }
    return best;
  }

  [[nodiscard]] long likelihood(GridCell at) const {
    const int nearest = brute_force(at);
    if (nearest == PointGrid::none) return 0;
    const GridCell cell = cells[static_cast<std::size_t>(nearest)];
    const double d = resolution * std::hypot(cell.column - at.column, cell.row - at.row);
    return std::lround(255.0 * std::exp(-d * d / (2.0 * sigma * sigma)));
  }
};

TEST(PointGrid, FindsTheNearestPointAsBruteForceDoes) {
  const World world(300, 4.0);
  Rng rng(8);
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto x = static_cast<float>(rng.uniform(-5.0, 5.0));
    const auto y = static_cast<float>(rng.uniform(-5.0, 5.0));
    const int expected = world.brute_force(world.grid.cell(x, y));
    ASSERT_EQ(world.grid.nearest(x, y), expected) << x << ", " << y;
    found += expected != PointGrid::none ? 1 : 0;
  }
  EXPECT_GT(found, 1000);
  EXPECT_LT(found, 4900);
}

TEST(PointGrid, LikelihoodsAreTheBruteForceOnesAcrossTileBorders) {
  const World world(300, 4.0);
  Rng rng(9);
  for (int i = 0; i < 500; ++i) {
    const GridCell first = world.grid.cell(static_cast<float>(rng.uniform(-5.0, 5.0)),
                                           static_cast<float>(rng.uniform(-5.0, 5.0)));
    std::array<std::uint8_t, std::size_t{5} * PointGrid::window_width> window{};
    world.grid.likelihood_rows(first, 5, window.data());
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column < PointGrid::window_width; ++column) {
        const int k = row * PointGrid::window_width + column;
        ASSERT_EQ(window.at(static_cast<std::size_t>(k)),
                  world.likelihood({first.column + column, first.row + row}));
      }
    }
  }
}

TEST(PointGrid, KnowsThePointInsideACell) {
  const World world(50, 1.0);
  for (std::size_t i = 0; i < world.cells.size(); ++i) {
    EXPECT_EQ(world.grid.inside(world.cells[i]), static_cast<int>(i));
  }
  EXPECT_EQ(world.grid.inside(world.grid.cell(50.0F, 50.0F)), PointGrid::none);
}

TEST(PointGrid, APointTakesFourTilesAtMost) {
  PointGrid grid(resolution, reach, sigma, many_tiles);
  // The origin is where four tiles meet.
  ASSERT_TRUE(grid.insert(grid.cell(0.0F, 0.0F), 0));
  EXPECT_EQ(grid.tiles(), 4U);
  // The middle of one of them, which is 3.2 m wide.
  ASSERT_TRUE(grid.insert(grid.cell(1.6F, 1.6F), 1));
  EXPECT_EQ(grid.tiles(), 4U);
  ASSERT_TRUE(grid.insert(grid.cell(101.6F, 1.6F), 2));
  EXPECT_EQ(grid.tiles(), 5U);
}

TEST(PointGrid, RefusesPointsWhenTilesRunOut) {
  PointGrid grid(resolution, reach, sigma, 4);
  ASSERT_TRUE(grid.insert(grid.cell(0.0F, 0.0F), 0));
  const GridCell far = grid.cell(20.0F, 0.0F);
  EXPECT_FALSE(grid.insert(far, 1));
  EXPECT_EQ(grid.inside(far), PointGrid::none);
  EXPECT_TRUE(grid.insert(grid.cell(1.0F, 1.0F), 1));
}

TEST(PointGrid, HoldsASquareAndNothingBeyond) {
  const PointGrid grid(resolution, reach, sigma, many_tiles);
  EXPECT_TRUE(grid.contains(818.0F, -818.0F));
  EXPECT_FALSE(grid.contains(820.0F, 0.0F));
  EXPECT_FALSE(grid.contains(0.0F, -820.0F));
  EXPECT_FALSE(grid.contains(1e30F, 0.0F));
  EXPECT_FALSE(grid.contains(std::numeric_limits<float>::quiet_NaN(), 0.0F));
  EXPECT_EQ(grid.nearest(1e30F, 0.0F), PointGrid::none);
  EXPECT_EQ(grid.nearest(0.0F, -1e30F), PointGrid::none);
}

TEST(PointGrid, AClearedGridIsLikeANewOneAndKeepsItsMemory) {
  World world(300, 4.0);
  const std::size_t bytes = world.grid.memory_bytes();
  world.grid.clear();
  EXPECT_EQ(world.grid.tiles(), 0U);
  for (const GridCell cell : world.cells) EXPECT_EQ(world.grid.inside(cell), PointGrid::none);
  for (std::size_t i = 0; i < world.cells.size(); ++i) ASSERT_TRUE(world.grid.insert(world.cells[i], i));
  EXPECT_EQ(world.grid.memory_bytes(), bytes);
  EXPECT_EQ(world.grid.nearest(0.3F, 0.3F), world.brute_force(world.grid.cell(0.3F, 0.3F)));
}

}  // namespace
}  // namespace glocal::local_mappers::point_grid_test
