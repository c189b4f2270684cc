#include "evaluation/running/reference_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glocal::test::reference_fit_test {
namespace {

using testing::HasSubstr;

/// A wall along y at x = 5, a point every 0.1 m.
GlobalMap wall() {
  MapData map;
  for (int i = -50; i <= 50; ++i) map.points.push_back({5.0F, 0.1F * static_cast<float>(i), 0.0F});
  return GlobalMap(std::move(map));
}

/// A robot that drives towards the wall and sees `on_wall` points of it, and as many others as make ten. The
/// reference is off by `error`.
Drive drive(int on_wall, const Pose2& error) {
  Drive drive;
  for (int i = 0; i < 4; ++i) {
    Sample sample;
    for (int k = 0; k < 10; ++k) {
      const double ahead = (k < on_wall ? 5.0 : 3.0) - i;
      sample.observation.scan.hits.push_back({static_cast<float>(ahead), 0.2F * static_cast<float>(k), 0.0F});
    }
    sample.map_from_robot = error * Pose2{1.0 * i, 0.0, 0.0};
    drive.samples.push_back(sample);
    drive.path_m.push_back(i);
  }
  return drive;
}

TEST(ReferenceFit, IsTheShareOfHitsOnTheMap) {
  EXPECT_DOUBLE_EQ(*reference_fit(drive(7, {}), wall(), 0.1), 0.7);
  EXPECT_DOUBLE_EQ(*reference_fit(drive(10, {}), wall(), 0.1), 1.0);
  EXPECT_DOUBLE_EQ(*reference_fit(drive(10, {0.2, 0.0, 0.0}), wall(), 0.1), 0.0);
}

TEST(ReferenceFit, ScansFitEachOtherWhereTheyWereMade) {
  Drive along = drive(10, {});
  for (std::size_t i = 0; i < along.samples.size(); ++i)
    along.samples[i].observation.stamp = static_cast<double>(i);
  const auto fit_with_shift = [&](double shift_s) {
    return fit_among_scans(
        along,
        [&](double stamp) -> std::optional<Pose3> {
          return Pose2{std::exp(stamp - shift_s), 0.0, 0.0};
        },
        0.05);
  };
  for (std::size_t i = 0; i < along.samples.size(); ++i) {
    Points hits;
    for (int k = 0; k < 10; ++k)
      hits.push_back(
          {static_cast<float>(30.0 - std::exp(static_cast<double>(i))), 0.2F * static_cast<float>(k), 0.0F});
    along.samples[i].observation.scan.hits = hits;
  }
  EXPECT_DOUBLE_EQ(*fit_with_shift(0.0), 1.0);
  EXPECT_DOUBLE_EQ(*fit_with_shift(0.2), 0.0);
  const auto nowhere = [](double stamp) { return stamp < 1.0 ? std::optional(Pose3{}) : std::nullopt; };
  EXPECT_FALSE(fit_among_scans(along, nowhere, 0.05));
}

TEST(ReferenceFit, FarAwayNothingIsRounded) {
  MapData data = wall().data();
  data.origin = {500'000.0, 4'649'776.0, 0.0};
  const GlobalMap map(std::move(data));
  const auto fit = [&](double error) {
    return *reference_fit(drive(10, {500'000.0 + error, 4'649'776.0, 0.0}), map, 0.01);
  };
  EXPECT_DOUBLE_EQ(fit(0.009), 1.0);
  EXPECT_DOUBLE_EQ(fit(0.012), 0.0);
  const auto at = [](double stamp) -> std::optional<Pose3> {
    return Pose2{500'000.0 + stamp, 4'649'776.0, 0.0};
  };
  Drive along = drive(10, {});
  for (std::size_t i = 0; i < along.samples.size(); ++i)
    along.samples[i].observation.stamp = static_cast<double>(i);
  EXPECT_DOUBLE_EQ(*fit_among_scans(along, at, 0.001), 1.0);
}

TEST(ReferenceFit, OnlyReferencesOfAnotherFrameAreDoubted) {
  EXPECT_FALSE(doubt_of_references(drive(2, {}), wall(), 0.1));
  const auto doubt = doubt_of_references(drive(10, {0.0, 0.0, std::numbers::pi}), wall(), 0.1);
  ASSERT_TRUE(doubt);
  EXPECT_THAT(*doubt, HasSubstr("only 0 % of what is seen lies within 0.1 m of the map"));
}

TEST(ReferenceFit, WithoutReferencesOrHitsNothingIsSaid) {
  Drive without = drive(0, {});
  for (Sample& sample : without.samples) sample.map_from_robot.reset();
  EXPECT_FALSE(reference_fit(without, wall(), 0.1));
  Drive blind = drive(0, {});
  for (Sample& sample : blind.samples) sample.observation.scan.hits = {};
  EXPECT_FALSE(doubt_of_references(blind, wall(), 0.1));
}

}  // namespace
}  // namespace glocal::test::reference_fit_test
