#include "matchers/mcl/free_space.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "glocal/error.hpp"

namespace glocal::mcl::free_space_test {
namespace {

TEST(FreeSpace, PlacesAndHeadingsAreUniformWhereCellsAreFree) {
  // Three free cells of six, in a grid that is turned and moved.
  OccupancyGrid grid{{2.0, -1.0, 0.7}, 0.5, 3, 2, PackedCells(6, Cell::unknown)};
  grid.cell(0, 0) = grid.cell(2, 0) = grid.cell(1, 1) = Cell::free;
  grid.cell(1, 0) = Cell::occupied;
  const FreeSpace space(grid);
  EXPECT_DOUBLE_EQ(space.square_metres(), 0.75);
  Rng rng(2);
  std::array<int, 6> times{};
  std::array<int, 8> headings{};
  constexpr int draws = 24000;
  for (int i = 0; i < draws; ++i) {
    const Pose2 pose = space.draw(rng);
    const Pose2 in_grid = inverse(grid.map_from_grid) * pose;
    ASSERT_EQ(grid.at(pose.x, pose.y), Cell::free);
    ++times.at(grid.index(static_cast<int>(in_grid.x / 0.5), static_cast<int>(in_grid.y / 0.5)));
    ++headings.at(static_cast<std::size_t>(std::floor((pose.theta + 3.14159266) / 0.785398164)));
  }
  // Four standard deviations of a binomial distribution.
  for (const std::size_t cell : {0U, 2U, 4U}) EXPECT_NEAR(times.at(cell), draws / 3.0, 300.0);
  for (const int count : headings) EXPECT_NEAR(count, draws / 8.0, 205.0);
}

TEST(FreeSpace, RefusesAMapWithoutAny) {
  OccupancyGrid grid{{}, 0.5, 2, 1, {Cell::unknown, Cell::occupied}};
  EXPECT_THROW(FreeSpace{grid}, ConfigError);
  EXPECT_THROW(FreeSpace{OccupancyGrid{}}, ConfigError);
}

}  // namespace
}  // namespace glocal::mcl::free_space_test
