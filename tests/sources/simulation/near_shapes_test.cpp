#include "sources/simulation/near_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "glocal/rng.hpp"

namespace glocal::simulation::near_shapes_test {
namespace {

/// Walls and pillars of all lengths over 400 m x 90 m, with one that crosses all of it.
Shapes many_shapes() {
  Rng rng(1);
  Shapes shapes;
  shapes.segments.push_back({{-30.0, -20.0}, {370.0, 70.0}});
  for (int i = 0; i < 2000; ++i) {
    const Position from{rng.uniform(-30.0, 370.0), rng.uniform(-20.0, 70.0)};
    const double length = i % 50 == 0 ? 40.0 : rng.uniform(0.1, 4.0);
    shapes.segments.push_back(
        {from, {from[0] + rng.uniform(-length, length), from[1] + rng.uniform(-length, length)}});
    if (i % 3 == 0) shapes.circles.push_back({from, rng.uniform(0.05, 2.0)});
  }
  return shapes;
}

TEST(NearShapes, RaysMeetTheSameAsAmongAllShapes) {
  const Shapes all = many_shapes();
  const NearShapes near(all);
  Rng rng(2);
  constexpr double reach = 15.0;
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    // Some of the places are off the world.
    const Position place{rng.uniform(-60.0, 400.0), rng.uniform(-50.0, 100.0)};
    const Shapes around = near.around(place, reach);
    const double angle = rng.uniform(0.0, 6.3);
    const Position direction{std::cos(angle), std::sin(angle)};
    const double expected = ray_distance(all, place, direction);
    const double distance = ray_distance(around, place, direction);
    if (expected > reach) {
      EXPECT_GE(distance, expected);
    } else {
      EXPECT_EQ(distance, expected);
      ++met;
    }
  }
  EXPECT_GT(met, 100);
}

TEST(NearShapes, LeavesOutWhatIsFarAway) {
  const Shapes all = many_shapes();
  const Shapes around = NearShapes(all).around({100.0, 30.0}, 15.0);
  EXPECT_LT(around.segments.size(), all.segments.size() / 4);
  // A square of 30 m, and the cells of 10 m that it meets in part.
  for (const Circle& circle : around.circles) EXPECT_LT(distance(circle.centre, {100.0, 30.0}), 40.0);
}

TEST(NearShapes, KeepsTheOrderAndNamesEachShapeOnce) {
  Shapes all;
  for (int i = 0; i < 5; ++i) {
    const double y = 5.0 - i;
    all.segments.push_back({{0.0, y}, {60.0, y}});
  }
  const Shapes around = NearShapes(all).around({30.0, 3.0}, 100.0);
  ASSERT_EQ(around.segments.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(around.segments[i].from, all.segments[i].from);
}

TEST(NearShapes, CanBeOfNothing) {
  const Shapes around = NearShapes({}).around({3.0, 4.0}, 1e9);
  EXPECT_TRUE(around.segments.empty() && around.circles.empty());
}

}  // namespace
}  // namespace glocal::simulation::near_shapes_test
