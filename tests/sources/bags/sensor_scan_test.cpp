#include "sources/bags/sensor_scan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace glocal::test::bags::sensor_scan_test {
namespace {

using glocal::bags::LaserScan;
using glocal::bags::PointCloud;
using glocal::bags::rays_of;
using glocal::bags::SensorScan;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Ahead, and from there to the left in quarters of a turn.
LaserScan scan_of(std::vector<float> ranges) {
  LaserScan scan;
  scan.angle_increment = 1.5707964F;
  scan.range_min = 0.2F;
  scan.range_max = 20.0F;
  scan.ranges = std::move(ranges);
  return scan;
}

TEST(SensorScan, ReadingsAreEndsOfRays) {
  const SensorScan rays = rays_of(scan_of({2.0F, 3.0F, 4.0F}), {});
  ASSERT_EQ(rays.hits.size(), 3U);
  EXPECT_EQ(rays.hits.x[0], 2.0F);
  EXPECT_NEAR(rays.hits.y[1], 3.0F, 1e-5F);
  EXPECT_NEAR(rays.hits.x[2], -4.0F, 1e-5F);
  EXPECT_THAT(rays.hit_times, IsEmpty());
}

TEST(SensorScan, WhatIsNoReadingSaysNothing) {
  const SensorScan rays = rays_of(scan_of({nan, -inf, -1.0F, 0.0F, 0.19F}), {});
  EXPECT_TRUE(rays.hits.empty());
  EXPECT_TRUE(rays.free_ends.empty());
}

TEST(SensorScan, RaysWithoutReturnAreFreeForAWhile) {
  const SensorScan rays = rays_of(scan_of({inf, 20.0F, 19.9F}), {.free_range = 5.0});
  ASSERT_EQ(rays.free_ends.size(), 2U);
  EXPECT_EQ(rays.free_ends.x[0], 5.0F);
  EXPECT_NEAR(rays.free_ends.y[1], 5.0F, 1e-5F);
  EXPECT_EQ(rays.hits.size(), 1U);
  EXPECT_TRUE(rays_of(scan_of({inf}), {.free_range = 0.0}).free_ends.empty());
  EXPECT_EQ(rays_of(scan_of({inf}), {.max_range = 3.0, .free_range = 5.0}).free_ends.x[0], 3.0F);
}

TEST(SensorScan, AReadingAtTheLimitMetNothingHoweverTheLimitIsRounded) {
  // 8.19 in single precision is less than in double precision, and 8.18 is more.
  for (const double limit : {8.18, 8.19}) {
    const SensorScan rays = rays_of(scan_of({static_cast<float>(limit)}), {.max_range = limit});
    EXPECT_EQ(rays.hits.size(), 0U) << limit;
    EXPECT_EQ(rays.free_ends.size(), 1U) << limit;
  }
}

TEST(SensorScan, TheNarrowerLimitsHold) {
  const SensorScan rays =
      rays_of(scan_of({0.9F, 1.0F, 6.0F}), {.min_range = 1.0, .max_range = 6.0, .free_range = 0.0});
  ASSERT_EQ(rays.hits.size(), 1U);
  EXPECT_NEAR(rays.hits.y[0], 1.0F, 1e-5F);
}

TEST(SensorScan, EachRayOfAScanInMotionHasItsTime) {
  LaserScan scan = scan_of({1.0F, nan, inf, 2.0F});
  scan.time_increment = 0.01F;
  const SensorScan rays = rays_of(scan, {});
  EXPECT_THAT(rays.hit_times, ElementsAre(0.0F, 3.0F * 0.01F));
  EXPECT_THAT(rays.free_times, ElementsAre(2.0F * 0.01F));
}

PointCloud cloud_of(std::vector<double> times) {
  PointCloud cloud;
  cloud.header.stamp_ns = 1'000'000'000'000;
  for (std::size_t i = 0; i < times.size(); ++i)
    cloud.points.push_back({static_cast<float>(i + 1), 0.0F, 0.0F});
  cloud.times = std::move(times);
  return cloud;
}

TEST(SensorScan, TimesOfCloudsCountFromTheirStamp) {
  EXPECT_THAT(rays_of(cloud_of({-0.1, 0.0, 0.05}), {}).hit_times, ElementsAre(-0.1F, 0.0F, 0.05F));
  const SensorScan absolute = rays_of(cloud_of({1000.0, 1000.25}), {});
  EXPECT_THAT(absolute.hit_times, ElementsAre(0.0F, 0.25F));
  const SensorScan other_clock = rays_of(cloud_of({5.0, 5.5}), {});
  EXPECT_THAT(other_clock.hit_times, ElementsAre(0.0F, 0.5F));
}

TEST(SensorScan, PointsOfCloudsOutOfRangeAreDropped) {
  const SensorScan rays = rays_of(cloud_of({0.0, 0.1, 0.2, 0.3}), {.min_range = 1.5, .max_range = 4.0});
  EXPECT_THAT(rays.hits.x, ElementsAre(2.0F, 3.0F));
  EXPECT_THAT(rays.hit_times, ElementsAre(0.1F, 0.2F));
}

TEST(SensorScan, VoxelsOfCloudsHaveTheMeanPointAndTime) {
  const SensorScan rays = rays_of(cloud_of({0.0, 0.5, 0.25}), {.voxel_size = 2.5});
  EXPECT_THAT(rays.hits.x, ElementsAre(1.5F, 3.0F));
  EXPECT_THAT(rays.hit_times, ElementsAre(0.25F, 0.25F));
}

}  // namespace
}  // namespace glocal::test::bags::sensor_scan_test
