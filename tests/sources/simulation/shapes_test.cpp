#include "sources/simulation/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glocal::simulation::shapes_test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
const double half = std::sqrt(0.5);

TEST(RayDistance, MeetsTheNearestWall) {
  Shapes shapes;
  shapes.segments = {{{5, -1}, {5, 1}}, {{3, -1}, {3, 1}}, {{-2, -1}, {-2, 1}}};
  EXPECT_DOUBLE_EQ(ray_distance(shapes, {0, 0}, {1, 0}), 3.0);
  EXPECT_DOUBLE_EQ(ray_distance(shapes, {4, 0.5}, {1, 0}), 1.0);
  EXPECT_DOUBLE_EQ(ray_distance(shapes, {0, 0}, {-1, 0}), 2.0);
  EXPECT_EQ(ray_distance(shapes, {0, 0}, {0, 1}), infinite);
  EXPECT_EQ(ray_distance(shapes, {0, 1.01}, {1, 0}), infinite) << "past the walls' ends";
  EXPECT_EQ(ray_distance({}, {0, 0}, {1, 0}), infinite);
}

TEST(RayDistance, MeetsASlantedWall) {
  // From the origin at 45 degrees to the line x + y = 4: 4 / sqrt(2).
  Shapes shapes;
  shapes.segments = {{{4, 0}, {0, 4}}};
  EXPECT_NEAR(ray_distance(shapes, {0, 0}, {half, half}), 2.0 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(ray_distance(shapes, {0, 0}, {0.6, 0.8}), 4.0 / 1.4, 1e-12);
}

TEST(RayDistance, MeetsCirclesFromOutsideAndInside) {
  Shapes shapes;
  shapes.circles = {{{4, 1}, 1.25}};
  // Half the chord at 1 m from the centre is 0.75 m.
  EXPECT_NEAR(ray_distance(shapes, {0, 0}, {1, 0}), 3.25, 1e-12);
  EXPECT_NEAR(ray_distance(shapes, {4, 0}, {1, 0}), 0.75, 1e-12);
  EXPECT_EQ(ray_distance(shapes, {6, 0}, {1, 0}), infinite) << "the circle lies behind";
  EXPECT_EQ(ray_distance(shapes, {0, -0.3}, {1, 0}), infinite);
}

TEST(Clearance, IsTheDistanceToTheNearestOutline) {
  Shapes shapes;
  shapes.segments = {{{0, 0}, {4, 0}}};
  shapes.circles = {{{2, 5}, 1}};
  EXPECT_NEAR(clearance(shapes, {1, 0.5}), 0.5, 1e-12);
  EXPECT_NEAR(clearance(shapes, {7, 4}), std::sqrt(26.0) - 1.0, 1e-12);
  EXPECT_NEAR(clearance(shapes, {-3, -4}), 5.0, 1e-12);
  EXPECT_NEAR(clearance(shapes, {2, 4.75}), 0.75, 1e-12) << "from within";
}

TEST(RayDistanceInSpace, PassesOverWhatIsLower) {
  Shapes shapes;
  shapes.segments = {{{2, -1}, {2, 1}, 1.0}, {{5, -1}, {5, 1}, 3.0}};
  EXPECT_DOUBLE_EQ(ray_distance_in_space(shapes, {0, 0, 0.9}, {1, 0, 0}), 2.0);
  EXPECT_DOUBLE_EQ(ray_distance_in_space(shapes, {0, 0, 1.1}, {1, 0, 0}), 5.0);
  // At 45 degrees up the near wall is passed 1.5 m high; at 45 degrees down it is missed below the floor.
  EXPECT_EQ(ray_distance_in_space(shapes, {0, 0, 0.5}, {half, 0, half}), infinite);
  EXPECT_EQ(ray_distance_in_space(shapes, {0, 0, 0.5}, {half, 0, -half}), infinite);
  EXPECT_EQ(ray_distance_in_space(shapes, {0, 0, 0.5}, {0, 0, 1}), infinite);
}

TEST(RayDistanceInSpace, MeetsTops) {
  Shapes shapes;
  shapes.circles = {{{3, 0}, 1.0, 1.0}};
  shapes.tops = {{{{{-4, -1}, {-2, -1}, {-2, 1}, {-4, 1}}}, 1.0}};
  const double diagonal = 1.0 / half;
  // From 3 m, at 45 degrees down, 2 m away.
  EXPECT_NEAR(ray_distance_in_space(shapes, {1, 0, 3}, {half, 0, -half}), 2.0 * diagonal, 1e-12);
  EXPECT_NEAR(ray_distance_in_space(shapes, {-1, 0, 3}, {-half, 0, -half}), 2.0 * diagonal, 1e-12);
  EXPECT_EQ(ray_distance_in_space(shapes, {-1, 1.5, 3}, {-half, 0, -half}), infinite) << "beside it";
  EXPECT_DOUBLE_EQ(ray_distance_in_space(shapes, {3, 0.5, 3}, {0, 0, -1}), 2.0) << "from above";
  EXPECT_DOUBLE_EQ(ray_distance_in_space(shapes, {0, 0, 0.5}, {1, 0, 0}), 2.0) << "the side";
}

}  // namespace
}  // namespace glocal::simulation::shapes_test
