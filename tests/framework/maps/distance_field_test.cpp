#include "glocal/distance_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "glocal/error.hpp"
#include "glocal/rng.hpp"
#include "instruction_sets.hpp"
#include "points.hpp"
#include "test_world.hpp"

namespace glocal::distance_field_test {
namespace {

TEST(DistanceField, IsTheDistanceToTheNearestPointUpToItsReach) {
  const Points points = test::small_world_points();
  const DistanceField field(points, 0.05, 0.5);
  Rng rng(2);
  for (int i = 0; i < 2000; ++i) {
    const auto x = static_cast<float>(rng.uniform(-2.0, 10.0));
    const auto y = static_cast<float>(rng.uniform(-2.0, 11.0));
    float nearest = field.reach();
    for (std::size_t k = 0; k < points.size(); ++k) {
      nearest = std::min(nearest, std::hypot(x - points.x[k], y - points.y[k]));
    }
    EXPECT_NEAR(field.at(x, y).distance, nearest, 0.03) << x << " " << y;
  }
}

TEST(DistanceField, ItsDerivativesAreThoseOfItsValues) {
  const DistanceField field(test::small_world_points(), 0.05, 0.5);
  Rng rng(2);
  constexpr float h = 1e-3F;
  int checked = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto x = static_cast<float>(rng.uniform(-0.4, 8.4));
    const auto y = static_cast<float>(rng.uniform(-0.4, 9.4));
    const auto value = field.at(x, y);
    const float dx = (field.at(x + h, y).distance - field.at(x - h, y).distance) / (2.0F * h);
    const float dy = (field.at(x, y + h).distance - field.at(x, y - h).distance) / (2.0F * h);
    // Where a cell ends, the difference looks into the next one.
    if (std::abs(dx - value.dx) > 0.1F || std::abs(dy - value.dy) > 0.1F) continue;
    ++checked;
  }
  EXPECT_GT(checked, 2700);
}

TEST(DistanceField, ManyPlacesAreLookedUpAsEachByItself) {
  const DistanceField field(test::small_world_points(), 0.05, 0.5);
  const Transform map_from_points(Pose2{0.3, -0.2, 0.5});
  Rng rng(4);
  Points points;
  for (int i = 0; i < 1003; ++i)
    points.push_back(
        {static_cast<float>(rng.uniform(-2.0, 10.0)), static_cast<float>(rng.uniform(-2.0, 11.0)), 0.0F});
  points.set(3, {1e30F, 0.0F, 0.0F});
  test::with_every_instruction_set([&] {
    FieldValues values;
    field.at(points, map_from_points, values);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point p = map_from_points(points[i]);
      const DistanceField::Value expected = field.at(p.x, p.y);
      EXPECT_EQ(values.x[i], p.x);
      EXPECT_EQ(values.y[i], p.y);
      EXPECT_EQ(values.distance[i], expected.distance);
      EXPECT_EQ(values.dx[i], expected.dx);
      EXPECT_EQ(values.dy[i], expected.dy);
    }
  });
}

TEST(DistanceField, FarAwayAndNotANumberAreBeyondReach) {
  const DistanceField field(test::small_world_points(), 0.05, 0.5);
  EXPECT_EQ(field.at(1e30F, 0.0F).distance, 0.5F);
  EXPECT_EQ(field.at(NAN, 0.0F).distance, 0.5F);
  EXPECT_EQ(field.at(-50.0F, 3.0F).dx, 0.0F);
}

TEST(DistanceField, TilesWithoutAnyPointNearTakeNoMemory) {
  const Points points = test::points_of({{0.0F, 0.0F, 0.0F}, {999.98F, 1000.03F, 0.0F}});
  const DistanceField field(points, 0.05, 0.5);  // 400 million cells
  EXPECT_LT(field.memory_bytes(), 7'000'000U);
  EXPECT_NEAR(field.at(0.2F, 0.1F).distance, std::hypot(0.2, 0.1), 0.01);
  EXPECT_NEAR(field.at(999.7F, 1000.0F).distance, std::hypot(0.28, 0.03), 0.01);
  EXPECT_EQ(field.at(500.0F, 500.0F).distance, 0.5F);
  EXPECT_EQ(field.at(500.0F, 500.0F).dx, 0.0F);
}

TEST(DistanceField, IsTheSameForAnyNumberOfThreads) {
  const Points points = test::small_world_points();
  const DistanceField one(points, 0.05, 0.5, 1);
  const DistanceField three(points, 0.05, 0.5, 3);
  for (float x = -1.0F; x < 10.0F; x += 0.07F) {
    for (float y = -1.0F; y < 10.0F; y += 0.07F) {
      EXPECT_EQ(one.at(x, y).distance, three.at(x, y).distance);
      EXPECT_EQ(one.at(x, y).dx, three.at(x, y).dx);
    }
  }
}

TEST(DistanceField, RefusesWhatDoesNotFitIntoMemory) {
  const Points points = test::points_of({{0.0F, 0.0F, 0.0F}, {1e5F, 1e5F, 0.0F}});
  EXPECT_THROW(DistanceField(points, 0.05, 0.5), ConfigError);
}

TEST(RefinedPose, ComesBackFromAShiftAndATurn) {
  const Points world = test::small_world_points();
  const DistanceField field(world, 0.05, 0.5);
  const Pose2 truth{5.5, 2.5, 0.7};
  const Points seen = test::seen_from(world, truth, 4.0);
  Rng rng(4);
  for (int i = 0; i < 20; ++i) {
    const Pose2 start =
        truth * Pose2{rng.uniform(-0.15, 0.15), rng.uniform(-0.15, 0.15), rng.uniform(-0.08, 0.08)};
    const Pose2 pose = refined_pose(field, seen, start, {.iterations = 30});
    EXPECT_LT(distance(pose, truth), 0.02) << i;
    EXPECT_LT(rotation_between(pose, truth), radians(0.5)) << i;
  }
}

TEST(RefinedPose, TurnsPointsFarFromTheirOrigin) {
  const Points world = test::small_world_points();
  const DistanceField field(world, 0.05, 0.5);
  const Pose2 truth{5.5, 2.5, 0.7};
  const Pose2 origin_from_robot{600.0, -300.0, 1.1};
  const Points seen = moved(test::seen_from(world, truth, 4.0), origin_from_robot);
  for (const double off : {-2.0, 2.0}) {
    const Pose2 start = truth * Pose2{0.0, 0.0, radians(off)} * inverse(origin_from_robot);
    const Pose2 pose = refined_pose(field, seen, start, {.iterations = 30}) * origin_from_robot;
    EXPECT_LT(distance(pose, truth), 0.02) << off;
    EXPECT_LT(rotation_between(pose, truth), radians(0.2)) << off;
  }
}

TEST(RefinedPose, StaysWherePointsSayNothing) {
  const DistanceField field(test::small_world_points(), 0.05, 0.5);
  const Points seen = test::points_of({{0.0F, 0.0F, 0.0F}});
  const Pose2 nowhere{100.0, 100.0, 0.3};
  EXPECT_EQ(refined_pose(field, seen, nowhere, {}), nowhere);
  EXPECT_EQ(refined_pose(field, {}, nowhere, {}), nowhere);
}

/// Points every 5 cm, up to `reach` to both sides, on a wall along x and, if asked for, on another along y.
Points walls(int reach_cells, bool corner) {
  Points points;
  for (int i = -reach_cells; i <= reach_cells; ++i) {
    const float along = 0.05F * static_cast<float>(i);
    points.push_back({along, 1.0F, 0.0F});
    if (corner) points.push_back({2.0F, along, 0.0F});
  }
  return points;
}

TEST(PoseCovariance, IsThatOfALineFitAcrossAWall) {
  const DistanceField field(walls(80, false));
  const Points seen = walls(60, false);  // the wall goes on to both sides
  const Pose2 off{0.0, 0.02, 0.0};
  const PoseCovariance c = pose_covariance(field, seen, off, off, 0.15);
  EXPECT_GT(c.xx, 0.5);  // along the wall nothing is known
  // Every point is 2 cm off and weighs (15^2 / (15^2 + 2^2))^2. A line through n such points is uncertain by
  // 0.02^2 / (weight n) across, and by 0.02^2 / (weight sum of x^2) in its direction. Eight of them count as
  // one, and the heading has drifted by 0.2 degrees.
  const double weight = std::pow(0.0225 / (0.0225 + 0.0004), 2.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) squares += double{seen.x[i]} * seen.x[i];
  EXPECT_NEAR(c.yy, 8.0 * 0.0004 / (weight * 121.0), 0.05 * c.yy);
  EXPECT_NEAR(c.tt, 8.0 * 0.0004 / (weight * squares) + std::pow(radians(0.2), 2.0), 0.05 * c.tt);
  EXPECT_NEAR(c.yt, 0.0, 1e-7);
}

TEST(PoseCovariance, ASecondWallSettlesTheOtherDirection) {
  const Points corner = walls(60, true);
  const Pose2 off{0.02, 0.02, 0.0};
  const PoseCovariance c = pose_covariance(DistanceField(corner), corner, off, off, 0.15);
  EXPECT_LT(c.xx, 0.01);
  EXPECT_LT(c.yy, 0.01);
}

}  // namespace
}  // namespace glocal::distance_field_test
