#include "matchers/mcl/heaps.hpp"

#include <gtest/gtest.h>

namespace glocal::heaps_test {
namespace {

constexpr PoseBinning binning{.side = 0.25, .turns = 40};

TEST(Heaps, AreParticlesOfACellToldAsTheirWeightedMean) {
  const std::vector<Pose2> particles = {{1.05, 2.05, 0.02}, {3.05, 0.05, 1.6}, {1.15, 2.10, 0.05}};
  const auto heaps = heaps_of(particles, {0.6, 0.1, 0.3}, binning, 10);
  ASSERT_EQ(heaps.size(), 2U);
  EXPECT_NEAR(heaps[0].weight, 0.9, 1e-12);
  EXPECT_NEAR(heaps[0].mean().x, (0.6 * 1.05 + 0.3 * 1.15) / 0.9, 1e-12);
  EXPECT_NEAR(heaps[0].mean().y, (0.6 * 2.05 + 0.3 * 2.10) / 0.9, 1e-12);
  EXPECT_NEAR(heaps[0].mean().theta, (0.6 * 0.02 + 0.3 * 0.05) / 0.9, 1e-5);
  EXPECT_NEAR(heaps[1].weight, 0.1, 1e-12);
}

TEST(Heaps, HeadingsOnBothSidesOf180DegreesAreOneHeap) {
  const std::vector<Pose2> particles = {{1.05, 2.05, radians(179.0)}, {1.05, 2.05, radians(-178.0)}};
  const auto heaps = heaps_of(particles, {0.5, 0.5}, binning, 10);
  ASSERT_EQ(heaps.size(), 1U);
  EXPECT_NEAR(heaps[0].mean().theta, radians(-179.5), 1e-9);
}

TEST(Heaps, TheHeaviestAreLeft) {
  const std::vector<Pose2> particles = {{1.05, 0.05, 0.02}, {2.05, 0.05, 0.02}, {3.05, 0.05, 0.02}};
  const auto heaps = heaps_of(particles, {0.2, 0.5, 0.3}, binning, 2);
  ASSERT_EQ(heaps.size(), 2U);
  EXPECT_NEAR(heaps[0].mean().x, 2.05, 1e-12);
  EXPECT_NEAR(heaps[1].mean().x, 3.05, 1e-12);
}

}  // namespace
}  // namespace glocal::heaps_test
