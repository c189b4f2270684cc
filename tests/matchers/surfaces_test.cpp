#include "matchers/surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "test_world.hpp"

namespace glocal {
namespace {

/// A straight wall along x = 2 with free cells on the chosen sides of it.
GlobalMap wall(bool free_left, bool free_right) {
  MapData data;
  testing::add_wall(data.points, {{2.025, 0.0}, {2.025, 4.0}});
  data.grid = {{0.0, 0.0, 0.0}, 0.05, 80, 80, std::vector<Cell>(std::size_t{80} * 80, Cell::unknown)};
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

TEST(Surfaces, NormalsPointToTheFreeSide) {
  for (const bool left : {true, false}) {
    const GlobalMap map = wall(left, !left);
    const Surfaces surfaces = surfaces_of(map, {});
    EXPECT_NEAR(static_cast<double>(surfaces.size()), 40.0, 1.0);  // one every 0.1 m
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      EXPECT_NEAR(surfaces.x[i], 2.025, 1e-5);
      EXPECT_LT(turned(surfaces.angle[i], left ? std::numbers::pi : 0.0), 1e-3);
    }
  }
}

TEST(Surfaces, AWallThatIsFreeOnBothSidesOrOnNoneCountsTwice) {
  EXPECT_NEAR(static_cast<double>(surfaces_of(wall(true, true), {}).size()), 80.0, 2.0);
  EXPECT_NEAR(static_cast<double>(surfaces_of(wall(false, false), {}).size()), 80.0, 2.0);
}

TEST(Surfaces, WhatIsNoLineHasNoNormal) {
  MapData data;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k)
      data.points.push_back({0.05F * static_cast<float>(i), 0.05F * static_cast<float>(k), 0.0F});
  }
  data.points.push_back({5.0F, 5.0F, 0.0F});
  data.grid = {{}, 0.1, 1, 1, {Cell::unknown}};
  const Surfaces surfaces = surfaces_of(GlobalMap(std::move(data)), {});
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    EXPECT_LT(surfaces.x[i], 1.0) << "a single point";
    const bool inside =
        surfaces.x[i] > 0.1F && surfaces.x[i] < 0.25F && surfaces.y[i] > 0.1F && surfaces.y[i] < 0.25F;
    EXPECT_FALSE(inside) << surfaces.x[i] << " " << surfaces.y[i];
  }
}

TEST(Surfaces, ALocalMapsOwnNormalsAreTakenAndZeroOnesLeftOut) {
  LocalMap local;
  local.points.push_back({1.0F, 2.0F, 0.0F});
  local.points.push_back({3.0F, 4.0F, 0.0F});
  local.normals.push_back({0.0F, 0.0F, 0.0F});
  local.normals.push_back({0.0F, -1.0F, 0.0F});
  const Surfaces surfaces = surfaces_of(local, {});
  ASSERT_EQ(surfaces.size(), 1U);
  EXPECT_EQ(surfaces.x[0], 3.0F);
  EXPECT_NEAR(surfaces.angle[0], -std::numbers::pi / 2.0, 1e-6);
}

TEST(Surfaces, ALocalMapWithoutNormalsGetsBothDirections) {
  LocalMap local;
  testing::add_wall(local.points, {{0.025, 0.0}, {0.025, 2.0}});
  const Surfaces surfaces = surfaces_of(local, {});
  EXPECT_NEAR(static_cast<double>(surfaces.size()), 40.0, 2.0);
  const auto to_the_right = std::count_if(surfaces.angle.begin(), surfaces.angle.end(),
                                          [](float angle) { return turned(angle, 0.0) < 1e-3; });
  EXPECT_EQ(2 * static_cast<std::size_t>(to_the_right), surfaces.size());
}

}  // namespace
}  // namespace glocal
