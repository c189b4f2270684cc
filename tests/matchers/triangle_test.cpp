#include "matchers/triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "glocal/rng.hpp"
#include "test_world.hpp"

namespace glocal {
namespace {

Points make_points(const std::vector<std::pair<float, float>>& xy) {
  Points points;
  for (const auto& [x, y] : xy) points.push_back({x, y, 0.0F});
  return points;
}

constexpr Relation relation_of(Relation a, Relation b, Relation c) {
  return a << 24U | b << 12U | c;
}

TEST(CanonicalTriangle, AllOrdersOfDrawingGiveTheSame) {
  // Sides 5 (0-1), 4 (1-2), 3 (2-0) of a right triangle; counter-clockwise from its longest side.
  const Points points = make_points({{0, 0}, {5, 0}, {1.8F, 2.4F}});
  Triple triple = {0, 1, 2};
  const TriangleRule rule{.cell = 0.3};
  do {
    const auto triangle = canonical_triangle(points, triple, rule);
    ASSERT_TRUE(triangle);
    EXPECT_EQ(triangle->triple, (Triple{0, 1, 2}));
    EXPECT_EQ(triangle->relation, relation_of(16, 13, 10));  // 5 / 0.3 = 16.7, 4 / 0.3 = 13.3, 3 / 0.3 = 10.0
  } while (std::next_permutation(triple.begin(), triple.end()));
}

TEST(CanonicalTriangle, MirroredTrianglesDiffer) {
  const Points points = make_points({{0, 0}, {5, 0}, {1.8F, 2.4F}, {0, 0}, {5, 0}, {1.8F, -2.4F}});
  const TriangleRule rule{.cell = 0.3};
  const auto a = canonical_triangle(points, {0, 1, 2}, rule);
  const auto b = canonical_triangle(points, {3, 4, 5}, rule);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(b->relation, relation_of(16, 10, 13));
  EXPECT_NE(a->relation, b->relation);
}

TEST(CanonicalTriangle, DoesNotDependOnThePose) {
  const Points points = make_points({{0, 0}, {4.05F, 0}, {1, 2.55F}});
  const TriangleRule rule;
  const auto expected = canonical_triangle(points, {0, 1, 2}, rule);
  ASSERT_TRUE(expected);
  for (double theta = -3.0; theta < 3.0; theta += 0.5) {
    const Points there = testing::moved(points, {3.0, -7.0, theta});
    const auto triangle = canonical_triangle(there, {2, 0, 1}, rule);
    ASSERT_TRUE(triangle);
    EXPECT_EQ(triangle->relation, expected->relation);
    EXPECT_EQ(triangle->triple, expected->triple);
  }
}

TEST(CanonicalTriangle, SkipsWhatGivesPoorPoses) {
  const TriangleRule rule{.cell = 0.1, .min_side = 0.3, .min_height = 0.1, .max_side = 10.0};
  EXPECT_FALSE(canonical_triangle(make_points({{0, 0}, {4, 0}, {0.2F, 0.2F}}), {0, 1, 2}, rule))
      << "side of 0.28 m";
  EXPECT_FALSE(canonical_triangle(make_points({{0, 0}, {4, 0}, {2, 0.09F}}), {0, 1, 2}, rule))
      << "height of 0.09 m";
  EXPECT_TRUE(canonical_triangle(make_points({{0, 0}, {4, 0}, {2, 0.11F}}), {0, 1, 2}, rule));
  EXPECT_FALSE(canonical_triangle(make_points({{0, 0}, {10.1F, 0}, {2, 2}}), {0, 1, 2}, rule))
      << "side of 10.1 m";
  EXPECT_FALSE(canonical_triangle(make_points({{0, 0}, {4, 0}, {2, 2}}), {0, 1, 1}, rule)) << "a point twice";
}

TEST(LeastSquaresMotion, FindsAKnownMotion) {
  const Points from = make_points({{1, 1}, {4, 1.5F}, {2, 3}});
  const Pose2 truth{-3.0, 0.5, 2.2};
  const Pose2 found = least_squares_motion(from, {0, 1, 2}, testing::moved(from, truth), {0, 1, 2}).pose();
  EXPECT_NEAR(found.x, truth.x, 1e-5);
  EXPECT_NEAR(found.y, truth.y, 1e-5);
  EXPECT_NEAR(found.theta, truth.theta, 1e-6);
}

TEST(LeastSquaresMotion, NoNearbyMotionFitsBetter) {
  const Points from = make_points({{1, 1}, {4, 1.5F}, {2, 3}});
  const Points to = make_points({{-1.1F, 0.9F}, {-1.4F, 4.0F}, {-3.1F, 2.1F}});
  const auto squares = [&](const Pose2& motion) {
    const Points there = testing::moved(from, motion);
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += std::pow(there.x[i] - to.x[i], 2) + std::pow(there.y[i] - to.y[i], 2);
    }
    return sum;
  };
  const Pose2 best = least_squares_motion(from, {0, 1, 2}, to, {0, 1, 2}).pose();
  for (const double d : {-0.01, 0.01}) {
    EXPECT_GT(squares({best.x + d, best.y, best.theta}), squares(best));
    EXPECT_GT(squares({best.x, best.y + d, best.theta}), squares(best));
    EXPECT_GT(squares({best.x, best.y, best.theta + d}), squares(best));
  }
}

}  // namespace
}  // namespace glocal
