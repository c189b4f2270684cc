#include "matchers/common/oriented_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "test_world.hpp"

namespace glocal::oriented_points_test {
namespace {

/// A straight wall along x = 2 with free cells on the chosen sides of it.
GlobalMap wall(bool free_left, bool free_right) {
  MapData data;
  test::add_wall(data.points, {{2.025, 0.0}, {2.025, 4.0}});
  data.grid = {{0.0, 0.0, 0.0}, 0.05, 80, 80, PackedCells(std::size_t{80} * 80, Cell::unknown)};
  for (int row = 0; row < 80; ++row) {
    for (int column = 0; column < 80; ++column) {
      if ((column < 40 && free_left) || (column > 40 && free_right)) data.grid.cell(column, row) = Cell::free;
    }
  }
  return GlobalMap(std::move(data));
}

double turned(float angle, double from) {
  return std::abs(wrap_angle(double{angle} - from));
}

/// Walls in cells of 5 cm from (-1, -1) to (5, 5), and what is free.
template <class IsFree>
GlobalMap walls(const std::vector<std::vector<std::pair<double, double>>>& lines, IsFree is_free) {
  MapData data;
  for (const auto& line : lines) test::add_wall(data.points, line);
  data.grid = {{-1.0, -1.0, 0.0}, 0.05, 120, 120, PackedCells(std::size_t{120} * 120, Cell::unknown)};
  for (int row = 0; row < 120; ++row) {
    for (int column = 0; column < 120; ++column) {
      const Pose2 centre = data.grid.centre(column, row);
      if (is_free(centre.x, centre.y)) data.grid.cell(column, row) = Cell::free;
    }
  }
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    data.grid.cell(static_cast<int>((data.points.x[i] + 1.0F) / 0.05F),
                   static_cast<int>((data.points.y[i] + 1.0F) / 0.05F)) = Cell::occupied;
  }
  return GlobalMap(std::move(data));
}

TEST(OrientedPoints, NormalsPointToTheFreeSide) {
  for (const bool left : {true, false}) {
    const GlobalMap map = wall(left, !left);
    const OrientedPoints oriented_points = oriented_points_of(map, {});
    EXPECT_NEAR(static_cast<double>(oriented_points.size()), 40.0, 1.0);  // one every 0.1 m
    for (std::size_t i = 0; i < oriented_points.size(); ++i) {
      EXPECT_NEAR(oriented_points.x[i], 2.025, 1e-5);
      EXPECT_LT(turned(oriented_points.angle[i], left ? std::numbers::pi : 0.0), 1e-3);
    }
  }
}

TEST(OrientedPoints, AWallThatIsFreeOnBothSidesOrOnNoneCountsTwice) {
  EXPECT_NEAR(static_cast<double>(oriented_points_of(wall(true, true), {}).size()), 80.0, 2.0);
  EXPECT_NEAR(static_cast<double>(oriented_points_of(wall(false, false), {}).size()), 80.0, 2.0);
}

TEST(OrientedPoints, AtACornerEachWallKeepsItsOwnNormal) {
  // The walls x = 0 and y = 0, up to 2 m long: seen from inside (x, y > 0), normals are 0 and 90 degrees;
  // from outside, 180 and -90 degrees.
  for (const bool inside : {true, false}) {
    const GlobalMap map = walls({{{0.025, 2.025}, {0.025, 0.025}, {2.025, 0.025}}}, [&](double x, double y) {
      return inside ? x > 0.05 && y > 0.05 && x < 3.0 && y < 3.0 : x < 0.0 || y < 0.0;
    });
    const OrientedPoints oriented_points = oriented_points_of(map, {});
    // One every 0.1 m of 4 m; the corner itself may have one more or less.
    EXPECT_NEAR(static_cast<double>(oriented_points.size()), 40.0, 1.0);
    for (std::size_t i = 0; i < oriented_points.size(); ++i) {
      const double off_upright = turned(oriented_points.angle[i], inside ? 0.0 : std::numbers::pi);
      const double off_level = turned(oriented_points.angle[i], (inside ? 0.5 : -0.5) * std::numbers::pi);
      if (oriented_points.y[i] > 0.1F) {
        EXPECT_LT(off_upright, radians(2.0)) << "at y " << oriented_points.y[i];
      }
      if (oriented_points.x[i] > 0.1F) {
        EXPECT_LT(off_level, radians(2.0)) << "at x " << oriented_points.x[i];
      }
      EXPECT_LT(std::min(off_upright, off_level), radians(10.0));
    }
  }
}

TEST(OrientedPoints, ASlantedCornerInCellsKeepsItsNormals) {
  // Two walls at right angles, turned by 30 degrees and cut into cells: points at the cells' centres.
  const Pose2 turn{1.0, 0.0, radians(30.0)};
  Points exact;
  test::add_wall(exact, {{0.0, 2.0}, {0.0, 0.0}, {2.0, 0.0}});
  MapData data;
  data.grid = {{-1.0, -1.0, 0.0}, 0.05, 120, 120, PackedCells(std::size_t{120} * 120, Cell::free)};
  const Points walls_in_map = test::moved(exact, turn);
  for (std::size_t i = 0; i < walls_in_map.size(); ++i) {
    data.grid.cell(static_cast<int>((walls_in_map.x[i] + 1.0F) / 0.05F),
                   static_cast<int>((walls_in_map.y[i] + 1.0F) / 0.05F)) = Cell::occupied;
  }
  data.points = occupied_centres(data.grid);
  const OrientedPoints oriented_points = oriented_points_of(GlobalMap(std::move(data)), {});
  EXPECT_GT(oriented_points.size(), 60U);  // some 36 cells of 0.1 m, free on both sides
  for (std::size_t i = 0; i < oriented_points.size(); ++i) {
    const Pose2 at =
        inverse(turn) * Pose2{oriented_points.x[i], oriented_points.y[i], oriented_points.angle[i]};
    // Up to half a turn: the wall's other side is free too.
    const auto off = [&](double direction) {
      return std::min(turned(static_cast<float>(at.theta), direction),
                      turned(static_cast<float>(at.theta), direction + std::numbers::pi));
    };
    if (at.y > 0.15) {
      EXPECT_LT(off(0.0), radians(12.0)) << "at y " << at.y;
    }
    if (at.x > 0.15) {
      EXPECT_LT(off(0.5 * std::numbers::pi), radians(12.0)) << "at x " << at.x;
    }
  }
}

TEST(OrientedPoints, BothSidesOfAThinWallPointAwayFromEachOther) {
  for (const double apart : {0.15, 0.2, 0.25, 0.3}) {
    const double other = 0.025 + apart;
    const GlobalMap map = walls({{{0.025, 0.025}, {0.025, 2.025}}, {{other, 0.025}, {other, 2.025}}},
                                [&](double x, double) { return x < 0.0 || x > other + 0.025; });
    const OrientedPoints oriented_points = oriented_points_of(map, {});
    EXPECT_NEAR(static_cast<double>(oriented_points.size()), 40.0, 2.0) << apart;
    for (std::size_t i = 0; i < oriented_points.size(); ++i) {
      const bool left = std::abs(oriented_points.x[i] - 0.025F) < 0.03F;
      EXPECT_LT(turned(oriented_points.angle[i], left ? std::numbers::pi : 0.0), radians(2.0)) << apart;
    }
  }
}

TEST(OrientedPoints, AWallOfOneCellBetweenTwoRoomsCountsOnceForEach) {
  const GlobalMap map = walls({{{2.025, 0.025}, {2.025, 4.025}}}, [](double, double) { return true; });
  const OrientedPoints oriented_points = oriented_points_of(map, {});
  EXPECT_NEAR(static_cast<double>(oriented_points.size()), 80.0, 2.0);
  const auto to_the_right = std::count_if(oriented_points.angle.begin(), oriented_points.angle.end(),
                                          [](float angle) { return turned(angle, 0.0) < radians(1.0); });
  const auto to_the_left =
      std::count_if(oriented_points.angle.begin(), oriented_points.angle.end(),
                    [](float angle) { return turned(angle, std::numbers::pi) < radians(1.0); });
  EXPECT_EQ(to_the_right, to_the_left);
  EXPECT_EQ(static_cast<std::size_t>(to_the_right + to_the_left), oriented_points.size());
}

TEST(OrientedPoints, WhatIsNoLineHasNoNormal) {
  MapData data;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k)
      data.points.push_back({0.05F * static_cast<float>(i), 0.05F * static_cast<float>(k), 0.0F});
  }
  data.points.push_back({5.0F, 5.0F, 0.0F});
  data.grid = {{}, 0.1, 1, 1, {Cell::unknown}};
  const OrientedPoints oriented_points = oriented_points_of(GlobalMap(std::move(data)), {});
  for (std::size_t i = 0; i < oriented_points.size(); ++i) {
    EXPECT_LT(oriented_points.x[i], 1.0) << "a single point";
    const bool inside = oriented_points.x[i] > 0.1F && oriented_points.x[i] < 0.25F &&
                        oriented_points.y[i] > 0.1F && oriented_points.y[i] < 0.25F;
    EXPECT_FALSE(inside) << oriented_points.x[i] << " " << oriented_points.y[i];
  }
}

TEST(OrientedPoints, TheirShareIsThatOfThePlacesWithANormal) {
  MapData data;
  test::add_wall(data.points, {{0.025, 0.025}, {3.025, 0.025}});  // 30 squares of 0.1 m
  for (int i = 0; i < 10; ++i) data.points.push_back({0.05F, 2.0F + static_cast<float>(i), 0.0F});  // alone
  data.grid = {{}, 0.1, 1, 1, {Cell::unknown}};
  const GlobalMap map(std::move(data));
  EXPECT_NEAR(oriented_points_of(map, {}).share, 0.75, 1e-9);
  const Points places = downsampled_in_plane(map.points(), 0.1);
  ASSERT_EQ(places.size(), 40U);
  EXPECT_NEAR(places.x[0], 0.05, 1e-6);  // of 0.025 and 0.075
  EXPECT_NEAR(places.y[0], 0.025, 1e-6);
}

TEST(OrientedPoints, ALocalMapsOwnNormalsAreTakenAndZeroOnesLeftOut) {
  LocalMap local;
  local.points.push_back({1.0F, 2.0F, 0.0F});
  local.points.push_back({3.0F, 4.0F, 0.0F});
  local.normals.push_back({0.0F, 0.0F, 0.0F});
  local.normals.push_back({0.0F, -1.0F, 0.0F});
  const OrientedPoints oriented_points = oriented_points_of(local, {});
  ASSERT_EQ(oriented_points.size(), 1U);
  EXPECT_EQ(oriented_points.x[0], 3.0F);
  EXPECT_NEAR(oriented_points.angle[0], -std::numbers::pi / 2.0, 1e-6);
}

TEST(OrientedPoints, ALocalMapWithoutNormalsGetsBothDirections) {
  LocalMap local;
  test::add_wall(local.points, {{0.025, 0.0}, {0.025, 2.0}});
  const OrientedPoints oriented_points = oriented_points_of(local, {});
  EXPECT_NEAR(static_cast<double>(oriented_points.size()), 40.0, 2.0);
  const auto to_the_right = std::count_if(oriented_points.angle.begin(), oriented_points.angle.end(),
                                          [](float angle) { return turned(angle, 0.0) < 1e-3; });
  EXPECT_EQ(2 * static_cast<std::size_t>(to_the_right), oriented_points.size());
}

TEST(OrientedPoints, WithoutAGridBothSidesOfAWallCount) {
  MapData data;
  test::add_wall(data.points, {{0, 0}, {4, 0}});
  const GlobalMap map(std::move(data));
  const OrientedPoints points = oriented_points_of(map, {});
  ASSERT_GT(points.size(), 60U);
  for (std::size_t i = 0; i < points.size(); i += 2) {
    EXPECT_EQ(points.x[i], points.x[i + 1]);
    EXPECT_NEAR(std::abs(points.angle[i] - points.angle[i + 1]), std::numbers::pi, 1e-5);
  }
}

}  // namespace
}  // namespace glocal::oriented_points_test
