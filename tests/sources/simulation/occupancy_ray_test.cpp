#include "sources/simulation/occupancy_ray.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sources/plan.hpp"

namespace glocal::simulation::occupancy_ray_test {
namespace {

using test::Plan;

TEST(OccupancyRay, IsThatToTheCellsBorder) {
  const OccupancyGrid grid = Plan(test::room_plan).grid();
  const Position place{1.25,
                       1.75};  // Free space is x 0.5 to 5.5 m, y 0.5 to 3 m, the pillar x 2.5, y 1.5 on.
  EXPECT_NEAR(ray_distance(grid, place, {1, 0}, 10.0, 0.0), 1.25, 1e-12) << "the pillar";
  EXPECT_NEAR(ray_distance(grid, place, {-1, 0}, 10.0, 0.0), 0.75, 1e-12);
  EXPECT_NEAR(ray_distance(grid, place, {0, 1}, 10.0, 0.0), 1.25, 1e-12);
  EXPECT_NEAR(ray_distance(grid, place, {0, -1}, 10.0, 0.0), 1.25, 1e-12);
  EXPECT_NEAR(ray_distance(grid, place, {0.6, 0.8}, 10.0, 0.0), 1.25 / 0.8, 1e-12) << "the upper wall";
  EXPECT_NEAR(ray_distance(grid, place, {-0.6, -0.8}, 10.0, 0.0), 0.75 / 0.6, 1e-12) << "the left wall";
}

TEST(OccupancyRay, IsInfiniteBeyondReachAndUnknownBehindTheMap) {
  const OccupancyGrid grid = Plan(test::room_plan).grid();
  EXPECT_EQ(ray_distance(grid, {1.25, 1.25}, {1, 0}, 4.0, 0.0), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(ray_distance(grid, {1.25, 1.25}, {1, 0}, 10.0, 0.0), 4.25, 1e-12);
  EXPECT_TRUE(std::isnan(ray_distance(grid, {1.25, 0.75}, {1, 0}, 10.0, 0.0))) << "the hole in the wall";
  EXPECT_TRUE(std::isnan(ray_distance(Plan({"..#"}).grid(), {0.25, 0.25}, {0, 1}, 10.0, 0.0))) << "the rim";
}

TEST(OccupancyRay, PassesBlurredRimsOfWalls) {
  // The rim is 1 m thick from x = 1 on, then from x = 3 on 1.5 m.
  const OccupancyGrid grid = Plan({"..??#???#"}).grid();
  EXPECT_NEAR(ray_distance(grid, {0.25, 0.25}, {1, 0}, 10.0, 1.1), 1.75, 1e-12);
  EXPECT_TRUE(std::isnan(ray_distance(grid, {0.25, 0.25}, {1, 0}, 10.0, 0.4)));
  EXPECT_TRUE(std::isnan(ray_distance(grid, {0.25, 0.25}, {-1, 0}, 10.0, 1.1))) << "off the grid";
}

TEST(OccupancyRay, FollowsATurnedMap) {
  // Turned by 90 degrees about the origin: what was x is y, what was y is -x.
  const OccupancyGrid grid = Plan(test::room_plan, "[0, 0, 1.5707963267948966]").grid();
  EXPECT_NEAR(ray_distance(grid, {-1.75, 1.25}, {0, 1}, 10.0, 0.0), 1.25, 1e-9) << "the pillar";
  EXPECT_NEAR(ray_distance(grid, {-1.75, 1.25}, {1, 0}, 10.0, 0.0), 1.25, 1e-9);
}

TEST(OccupancyRay, EndsAtAThing) {
  const OccupancyGrid grid = Plan(test::room_plan).grid();
  // The pillar is 1.25 m away.
  EXPECT_EQ(ray_distance(grid, {1.25, 1.75}, {1, 0}, 10.0, 0.0, 0.7), 0.7);
  EXPECT_NEAR(ray_distance(grid, {1.25, 1.75}, {1, 0}, 10.0, 0.0, 1.3), 1.25, 1e-12);
  EXPECT_EQ(ray_distance(grid, {1.25, 1.75}, {1, 0}, 1.0, 0.0, 0.99), 0.99) << "in the last cell";
  EXPECT_EQ(ray_distance(grid, {1.25, 1.75}, {1, 0}, 1.0, 0.0, 1.1), std::numeric_limits<double>::infinity());
}

TEST(OccupancyRay, MeetsThingsBeforeItIsLostOnly) {
  // Unknown from x = 1 m on.
  const OccupancyGrid grid = Plan({"..????#"}).grid();
  const auto distance = [&](double thing) {
    return ray_distance(grid, {0.25, 0.25}, {1, 0}, 10.0, 0.6, thing);
  };
  EXPECT_EQ(distance(0.5), 0.5);
  EXPECT_EQ(distance(1.3), 1.3) << "0.55 m of unknown cells";
  EXPECT_TRUE(std::isnan(distance(1.4))) << "0.65 m";
  EXPECT_TRUE(std::isnan(distance(2.7))) << "just before the wall";
}

}  // namespace
}  // namespace glocal::simulation::occupancy_ray_test
