#include "sources/simulation/near_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glocal/rng.hpp"

namespace glocal::simulation::near_shapes_test {
namespace {

/// Walls, pillars and boxes of all sizes over 400 m x 90 m, with a wall that crosses all of it.
Shapes many_shapes() {
  Rng rng(1);
  Shapes shapes;
  shapes.segments.push_back({{-30.0, -20.0}, {370.0, 70.0}, 2.0});
  for (int i = 0; i < 2000; ++i) {
    const Position from{rng.uniform(-30.0, 370.0), rng.uniform(-20.0, 70.0)};
    const double length = i % 50 == 0 ? 40.0 : rng.uniform(0.1, 4.0);
    const Position to{from[0] + rng.uniform(-length, length), from[1] + rng.uniform(-length, length)};
    const double height = rng.uniform(0.1, 3.0);
    shapes.segments.push_back({from, to, height});
    if (i % 3 == 0) shapes.circles.push_back({from, rng.uniform(0.05, 2.0), height});
    if (i % 5 == 0) shapes.tops.push_back({{from, {to[0], from[1]}, to, {from[0], to[1]}}, height});
  }
  return shapes;
}

void expect_the_same(double distance, double expected, double reach) {
  if (expected > reach) {
    EXPECT_GT(distance, reach);
  } else {
    EXPECT_EQ(distance, expected);
  }
}

TEST(NearShapes, RaysMeetTheSameAsAmongAllShapes) {
  const Shapes all = many_shapes();
  const NearShapes near(all);
  Rng rng(2);
  int met = 0, met_in_space = 0;
  for (int i = 0; i < 1000; ++i) {
    // Some of the places are off the world.
    const Position place{rng.uniform(-60.0, 400.0), rng.uniform(-50.0, 100.0)};
    const double reach = i % 2 == 0 ? 15.0 : 1e9;
    const double angle = i % 4 == 0 ? std::numbers::pi / 2.0 * (i % 3) : rng.uniform(0.0, 6.3);
    const Position direction{std::cos(angle), std::sin(angle)};
    const double expected = ray_distance(all, place, direction);
    expect_the_same(near.ray_distance(place, direction, reach), expected, reach);
    if (expected <= reach) ++met;

    const Vector3 eye{place[0], place[1], rng.uniform(0.0, 2.0)};
    const double rise = rng.uniform(-0.5, 0.2);
    const Vector3 look =
        i % 10 == 0 ? Vector3(0.0, 0.0, -1.0) : Vector3(direction[0], direction[1], rise).normalized();
    const double expected_in_space = ray_distance_in_space(all, eye, look);
    expect_the_same(near.ray_distance_in_space(eye, look, reach), expected_in_space, reach);
    if (expected_in_space <= reach) ++met_in_space;
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(met_in_space, 200);
}

TEST(NearShapes, AreMetOnTheBordersOfCellsToo) {
  // Cells begin at the lowest corner, and are 2.5 m wide.
  Shapes all;
  for (int i = 0; i <= 8; ++i) {
    const double at = 2.5 * i;
    all.segments.push_back({{at, 0.0}, {at, 20.0}});
    all.segments.push_back({{0.0, at}, {20.0, at}});
  }
  const NearShapes near(all);
  EXPECT_EQ(near.ray_distance({1.25, 1.25}, {1.0, 0.0}, 20.0), 1.25);
  EXPECT_EQ(near.ray_distance({1.25, 2.5}, {1.0, 0.0}, 20.0), 1.25) << "along a border";
  EXPECT_EQ(near.ray_distance({-5.0, 20.0}, {1.0, 0.0}, 20.0), 5.0) << "into the last cell";
  EXPECT_EQ(near.ray_distance({30.0, 1.0}, {-1.0, 0.0}, 20.0), 10.0) << "from outside";
}

TEST(NearShapes, CanBeOfNothing) {
  const NearShapes near({});
  EXPECT_TRUE(std::isinf(near.ray_distance({3.0, 4.0}, {1.0, 0.0}, 1e9)));
  EXPECT_TRUE(std::isinf(near.ray_distance_in_space({3.0, 4.0, 0.0}, {0.0, 0.0, 1.0}, 1e9)));
}

}  // namespace
}  // namespace glocal::simulation::near_shapes_test
