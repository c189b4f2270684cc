#include "sources/disturbed/range_disturbances.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glocal::disturbed::range_disturbances_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A sensor at (1, 0) that sees a circle of 4 m around it, by beams of `step_deg`, from straight behind on.
Scan circle(double step_deg, double range = 4.0) {
  Scan scan;
  scan.origin = {1.0F, 0.0F, 0.5F};
  for (double angle = -180.0; angle < 180.0; angle += step_deg)
    scan.hits.push_back({static_cast<float>(1.0 + range * std::cos(angle * pi / 180.0)),
                         static_cast<float>(range * std::sin(angle * pi / 180.0)), 0.5F});
  return scan;
}

template <class Change>
Scan changed(const Scan& scan, Change change, double amount) {
  Readings readings(scan);
  Rng rng(7);
  change(readings, amount, rng);
  return readings.scan();
}

std::vector<double> ranges_of(const Scan& scan) {
  std::vector<double> ranges;
  for (std::size_t i = 0; i < scan.hits.size(); ++i)
    ranges.push_back(std::hypot(scan.hits.x[i] - scan.origin.x, scan.hits.y[i] - scan.origin.y));
  return ranges;
}

double share_of(const std::vector<double>& ranges, double low, double high) {
  const auto within =
      std::count_if(ranges.begin(), ranges.end(), [&](double r) { return r >= low && r < high; });
  return static_cast<double>(within) / static_cast<double>(ranges.size());
}

TEST(Readings, KeepWhatNothingChanges) {
  Scan scan = circle(90.0);
  scan.times = {0.0F, 0.1F, 0.2F, 0.3F};
  scan.free_ends.push_back({9.0F, 0.0F, 0.5F});
  const Scan same = Readings(scan).scan();
  EXPECT_EQ(same.hits, scan.hits);
  EXPECT_EQ(same.free_ends, scan.free_ends);
  EXPECT_EQ(same.times, scan.times);
  EXPECT_EQ(same.origin, scan.origin);
  EXPECT_EQ(Readings(scan).farthest(), 8.0F);
}

TEST(RangeDisturbances, NoiseHasItsDeviationAndNoMean) {
  const std::vector<double> ranges = ranges_of(changed(circle(0.036), add_noise, 0.05));
  double sum = 0.0, squares = 0.0;
  for (const double r : ranges) {
    sum += r - 4.0;
    squares += (r - 4.0) * (r - 4.0);
  }
  const auto n = static_cast<double>(ranges.size());
  ASSERT_GT(n, 9990.0);
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * n));
}

TEST(RangeDisturbances, BiasAndStretchMoveEachEndAlongItsRay) {
  const Scan biased = changed(circle(90.0), add_bias, 0.5);
  EXPECT_NEAR(biased.hits.x[2], 5.5, 1e-6);
  EXPECT_NEAR(biased.hits.y[1], -4.5, 1e-6);
  EXPECT_EQ(biased.hits.z[2], 0.5F);
  const Scan stretched = changed(circle(90.0), stretch, 0.1);
  EXPECT_NEAR(stretched.hits.x[2], 5.4, 1e-6);
}

TEST(RangeDisturbances, OutliersAreUniform) {
  const std::vector<double> ranges = ranges_of(changed(circle(0.036), draw_outliers, 0.3));
  EXPECT_NEAR(share_of(ranges, 3.999, 4.001), 0.7, 0.02);
  EXPECT_NEAR(share_of(ranges, 0.0, 2.0), 0.15, 0.015);
}

TEST(RangeDisturbances, DustEndsRaysAsTheirWayIsLong) {
  // Of rays of 4 m, exp(-0.1 * 4) are left, and exp(-0.1 * 2) get beyond 2 m.
  const std::vector<double> ranges = ranges_of(changed(circle(0.036), raise_dust, 0.1));
  EXPECT_NEAR(share_of(ranges, 3.999, 4.001), std::exp(-0.4), 0.02);
  EXPECT_NEAR(share_of(ranges, 2.0, 4.001), std::exp(-0.2), 0.02);
}

TEST(RangeDisturbances, EdgesAreMixedAndNothingElse) {
  Scan scan;
  for (const float range : {2.0F, 2.1F, 5.0F, 5.1F, 3.0F})
    scan.hits.push_back({range * std::cos(0.01F * static_cast<float>(scan.hits.size())),
                         range * std::sin(0.01F * static_cast<float>(scan.hits.size())), 0.0F});
  const std::vector<double> ranges = ranges_of(changed(scan, mix_at_edges, 1.0));
  EXPECT_NEAR(ranges[0], 2.0, 1e-6);
  EXPECT_NEAR(ranges[1], 2.1, 1e-6);
  EXPECT_GT(ranges[2], 2.1);
  EXPECT_LT(ranges[2], 5.0);
  EXPECT_GT(ranges[3], 3.0);
  EXPECT_LT(ranges[3], 5.1);
  EXPECT_NEAR(ranges[4], 3.0, 1e-6);
}

TEST(RangeDisturbances, BeamsAreDroppedByTheirShare) {
  EXPECT_NEAR(static_cast<double>(changed(circle(0.036), drop_beams, 0.75).hits.size()) / 1e4, 0.25, 0.02);
}

TEST(RangeDisturbances, SparseScansHaveOneBeamInEachStep) {
  EXPECT_EQ(changed(circle(1.0), thin_out, 10.0).hits.size(), 36U);
  EXPECT_EQ(changed(circle(1.0), thin_out, 1.0).hits.size(), 360U);
  // Two rings of a lidar, each by itself.
  Scan rings = circle(1.0);
  for (std::size_t i = 0; i < 360; ++i) rings.hits.push_back({rings.hits.x[i], rings.hits.y[i], 1.5F});
  EXPECT_EQ(changed(rings, thin_out, 10.0).hits.size(), 72U);
}

TEST(RangeDisturbances, WhatIsOutOfRangeIsFreeUpToThere) {
  Scan scan = circle(90.0);
  scan.hits.push_back({2.0F, 0.0F, 0.5F});
  const Scan cut = changed(scan, cut_range, 3.0);
  ASSERT_EQ(cut.hits.size(), 1U);
  ASSERT_EQ(cut.free_ends.size(), 4U);
  EXPECT_NEAR(cut.free_ends.x[2], 4.0, 1e-6);
}

TEST(RangeDisturbances, TheViewIsAroundTheFront) {
  const Scan cut = changed(circle(1.0), cut_view, 61.0);
  EXPECT_EQ(cut.hits.size(), 61U);
  for (const float x : cut.hits.x) EXPECT_GE(x, 1.0 + 4.0 * std::cos(30.5 * pi / 180.0));
}

TEST(RangeDisturbances, SomebodyStandsBefore) {
  const std::vector<double> ranges = ranges_of(changed(circle(1.0), stand_before, 91.0));
  EXPECT_EQ(std::count_if(ranges.begin(), ranges.end(), [](double r) { return std::abs(r - 0.6) < 1e-5; }),
            91);
  EXPECT_EQ(std::count_if(ranges.begin(), ranges.end(), [](double r) { return std::abs(r - 4.0) < 1e-5; }),
            269);
}

TEST(RangeDisturbances, CrossTalkComesTenInARow) {
  const std::vector<double> ranges = ranges_of(changed(circle(0.036), cross_talk, 0.3));
  EXPECT_NEAR(share_of(ranges, 3.999, 4.001), 0.7, 0.05);
  for (std::size_t begin = 0; begin < ranges.size(); begin += 10) {
    for (std::size_t i = begin; i < begin + 10; ++i) EXPECT_NEAR(ranges[i], ranges[begin], 1e-4);
  }
}

TEST(RangeDisturbances, OfRingsEveryStepthIsLeft) {
  // Rings at -30, -10, 10 and 30 degrees, four rays each.
  Scan scan;
  for (const double up : {30.0, -10.0, -30.0, 10.0}) {
    for (const double bearing : {0.0, 90.0, 180.0, 270.0}) {
      const double flat = 5.0 * std::cos(up * pi / 180.0);
      scan.hits.push_back({static_cast<float>(flat * std::cos(bearing * pi / 180.0)),
                           static_cast<float>(flat * std::sin(bearing * pi / 180.0)),
                           static_cast<float>(5.0 * std::sin(up * pi / 180.0))});
    }
  }
  const Scan left = changed(scan, thin_rings, 2.0);
  ASSERT_EQ(left.hits.size(), 8U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(left.hits.z[i], -2.5, 1e-5);  // -30 degrees
  for (std::size_t i = 4; i < 8; ++i) EXPECT_NEAR(left.hits.z[i], 5.0 * std::sin(pi / 18.0), 1e-5);
  EXPECT_EQ(changed(circle(1.0), thin_rings, 16.0).hits, circle(1.0).hits);
}

}  // namespace
}  // namespace glocal::disturbed::range_disturbances_test
