#include "glocal/particles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "points.hpp"

namespace glocal::particles_test {
namespace {

constexpr PoseBinning binning{.side = 0.25, .turns = 40};

TEST(Particles, OfACellAreToldAsTheirWeightedMean) {
  const std::vector<Pose2> particles = {{1.05, 2.05, 0.02}, {3.05, 0.05, 1.6}, {1.15, 2.10, 0.05}};
  const auto sums = cell_sums({particles, {0.6, 0.1, 0.3}}, binning, 10);
  ASSERT_EQ(sums.size(), 2U);
  EXPECT_NEAR(sums[0].weight(), 0.9, 1e-12);
  EXPECT_NEAR(sums[0].mean().x, (0.6 * 1.05 + 0.3 * 1.15) / 0.9, 1e-12);
  EXPECT_NEAR(sums[0].mean().y, (0.6 * 2.05 + 0.3 * 2.10) / 0.9, 1e-12);
  EXPECT_NEAR(sums[0].mean().theta, (0.6 * 0.02 + 0.3 * 0.05) / 0.9, 1e-5);
  EXPECT_NEAR(sums[1].weight(), 0.1, 1e-12);
}

TEST(Particles, HeadingsOnBothSidesOf180DegreesAreOneSum) {
  const std::vector<Pose2> particles = {{1.05, 2.05, radians(179.0)}, {1.05, 2.05, radians(-178.0)}};
  const auto sums = cell_sums({particles, {0.5, 0.5}}, binning, 10);
  ASSERT_EQ(sums.size(), 1U);
  EXPECT_NEAR(sums[0].mean().theta, radians(-179.5), 1e-9);
}

TEST(Particles, TheHeaviestSumsAreLeft) {
  const std::vector<Pose2> particles = {{1.05, 0.05, 0.02}, {2.05, 0.05, 0.02}, {3.05, 0.05, 0.02}};
  const auto sums = cell_sums({particles, {0.2, 0.5, 0.3}}, binning, 2);
  ASSERT_EQ(sums.size(), 2U);
  EXPECT_NEAR(sums[0].mean().x, 2.05, 1e-12);
  EXPECT_NEAR(sums[1].mean().x, 3.05, 1e-12);
}

TEST(Particles, WhatWeighsNothingIsNowhere) {
  const std::vector<Pose2> particles = {{1.05, 0.05, 0.02}, {3.75, 0.05, 0.02}, {5.05, 0.05, 0.02}};
  const auto sums = cell_sums({particles, {1.0, std::exp(-744.0), 0.0}}, binning, 10);
  ASSERT_EQ(sums.size(), 1U) << "those of 1e-323 and of 0 have no mean";
  EXPECT_NEAR(sums[0].mean().x, 1.05, 1e-12);
  EXPECT_TRUE(cell_sums({particles, {0.0, 0.0, 0.0}}, binning, 10).empty());
}

/// A scan of three points of which two are in contact, and a local map of four, of which one is.
TEST(Particles, AHypothesisHasTheContactOfTheScanAndOfTheLocalMapOnceTheRobotHasMovedOn) {
  const Points wall = test::points_of({{5.0F, 1.0F, 0.0F}, {5.0F, 2.0F, 0.0F}});
  const KdTreeContact contact(wall, 0.05);
  // After 1 m ahead the robot stands at (4, 1) and looks along x.
  const Particles particles{{{3.0, 1.0, 0.0}, {3.0, 3.0, 0.0}}, {0.75, 0.25}};
  Scan scan;
  for (const Point& p : {Point{1.0F, 0.0F}, Point{1.0F, 1.0F}, Point{1.0F, 5.0F}}) scan.hits.push_back(p);
  LocalMap local;
  local.local_from_robot = Pose2{10.0, 20.0, radians(90.0)};
  // In the local frame the robot looks along y: what is 1 m ahead of it is 1 m up there.
  for (const Point& p : {Point{10.0F, 21.0F}, Point{11.0F, 21.0F}, Point{0.0F, 0.0F}, Point{7.0F, 7.0F}})
    local.points.push_back(p);
  const auto found = hypotheses_of(particles, {1.0, 0.0, 0.0}, {}, contact, local, scan, 0.5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].score, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(found[0].quality, 0.25, 1e-12);
  EXPECT_EQ(found[0].support, 2U);
  EXPECT_LT(distance(found[0].map_from_local * local.local_from_robot, Pose2{4.0, 1.0, 0.0}), 1e-9);
  EXPECT_EQ(hypotheses_of(particles, {1.0, 0.0, 0.0}, {}, contact, local, scan, 0.0).size(), 2U);
}

}  // namespace
}  // namespace glocal::particles_test
