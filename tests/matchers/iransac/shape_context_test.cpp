#include "matchers/iransac/shape_context.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glocal/rng.hpp"

namespace glocal::iransac::shape_context_test {
namespace {

OrientedPoints random_oriented_points(Rng& rng, int n) {
  OrientedPoints oriented_points;
  for (int i = 0; i < n; ++i) {
    oriented_points.add(static_cast<float>(rng.uniform(-3.0, 3.0)),
                        static_cast<float>(rng.uniform(-3.0, 3.0)),
                        static_cast<float>(rng.uniform(-3.14, 3.14)));
  }
  return oriented_points;
}

OrientedPoints moved(const OrientedPoints& oriented_points, const Pose2& motion) {
  OrientedPoints result;
  for (std::size_t i = 0; i < oriented_points.size(); ++i) {
    const Pose2 at = motion * Pose2{oriented_points.x[i], oriented_points.y[i], oriented_points.angle[i]};
    result.add(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.theta));
  }
  return result;
}

TEST(ShapeContexts, StayTheSameWhenAllIsMoved) {
  Rng rng(1);
  const OrientedPoints oriented_points = random_oriented_points(rng, 200);
  const std::vector<std::uint32_t> of{0, 17, 50, 199};
  const FeatureVectors before = shape_contexts(oriented_points, of, {});
  for (const double turn : {0.3, 1.7, -2.9}) {
    const FeatureVectors after = shape_contexts(moved(oriented_points, {12.0, -7.0, turn}), of, {});
    ASSERT_EQ(after.values.size(), before.values.size());
    for (std::size_t i = 0; i < of.size(); ++i) {
      EXPECT_LT(squared_distance(before[i], after[i], before.dimensions), 1e-6F);
    }
  }
}

TEST(ShapeContexts, OfDifferentPointsDiffer) {
  Rng rng(2);
  const OrientedPoints oriented_points = random_oriented_points(rng, 200);
  const FeatureVectors features = shape_contexts(oriented_points, {3, 4}, {});
  EXPECT_GT(squared_distance(features[0], features[1], features.dimensions), 0.1F);
}

TEST(ShapeContexts, HaveLengthOne) {
  Rng rng(3);
  const FeatureVectors features = shape_contexts(random_oriented_points(rng, 100), {0, 1, 2}, {});
  for (std::size_t i = 0; i < features.size(); ++i) {
    EXPECT_NEAR(dot(features[i], features[i], features.dimensions), 1.0F, 1e-5F);
  }
}

/// One neighbour 2 m straight ahead, in the middle of the only sector, so that all goes into one column of
/// rings.
TEST(ShapeContexts, OfOneNeighbourByHand) {
  OrientedPoints oriented_points;
  oriented_points.add(1.0F, 1.0F, 0.0F);
  // It faces the point, turned by 30 degrees from facing it squarely: doubled, 60 degrees.
  oriented_points.add(3.0F, 1.0F, static_cast<float>(std::numbers::pi + radians(30.0)));
  // Beyond the innermost ring (1 m), two more up to 4 m: each doubles the distance.
  const ShapeContextRule rule{.radius = 4.0, .nearest = 1.0, .rings = 3, .sectors = 1};
  const FeatureVectors features = shape_contexts(oriented_points, {0}, rule);
  ASSERT_EQ(features.dimensions, 6U);
  const float c = std::cos(std::numbers::pi_v<float> / 3.0F);
  const float s = std::sin(std::numbers::pi_v<float> / 3.0F);
  // 2 m is ring coordinate log2(2) + 0.5 = 1.5: the middle of the second ring.
  const std::vector<float> expected{0.0F, 0.0F, c, s, 0.0F, 0.0F};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(features[0][i], expected[i], 1e-5F);
}

TEST(ShapeContexts, DoNotCountWhatIsBehindTurnedAwayOrTooFar) {
  OrientedPoints oriented_points;
  oriented_points.add(0.0F, 0.0F, 0.0F);
  oriented_points.add(-1.0F, 0.0F, 0.0F);                                 // behind
  oriented_points.add(1.0F, 0.0F, 0.0F);                                  // shows its back
  oriented_points.add(9.0F, 0.0F, static_cast<float>(std::numbers::pi));  // far away
  const FeatureVectors features = shape_contexts(oriented_points, {0}, {});
  EXPECT_EQ(dot(features[0], features[0], features.dimensions), 0.0F);
}

TEST(ShapeContexts, AreTheSameForAnyNumberOfThreads) {
  Rng rng(4);
  const OrientedPoints oriented_points = random_oriented_points(rng, 300);
  const std::vector<std::uint32_t> of{5, 10, 200, 250, 299};
  EXPECT_EQ(shape_contexts(oriented_points, of, {}, 1).values,
            shape_contexts(oriented_points, of, {}, 2).values);
}

}  // namespace
}  // namespace glocal::iransac::shape_context_test
