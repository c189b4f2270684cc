#include "glocal/range_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"

namespace glocal::range_noise_test {
namespace {

Point hit_at(double range, double angle) {
  return {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0.0F};
}

/// From anywhere in a room of 8 m x 6 m to its walls, with beams all around and errors of range as told.
template <class Error>
Scan scan_of_room(double spacing_deg, Error error) {
  Scan scan;
  for (double angle = 0.003; angle < 2.0 * std::numbers::pi; angle += radians(spacing_deg)) {
    const double x = std::cos(angle), y = std::sin(angle);
    const double range = std::min((x > 0.0 ? 5.0 : -3.0) / x, (y > 0.0 ? 2.0 : -4.0) / y);
    scan.hits.push_back(hit_at(error(range), angle));
  }
  return scan;
}

TEST(RangeNoise, IsNoneOnWallsThatAreSeenExactly) {
  for (const double spacing_deg : {0.25, 1.0, 2.5}) {
    RangeNoise noise;
    noise.take_in(scan_of_room(spacing_deg, [](double range) { return range; }));
    ASSERT_TRUE(noise.deviation()) << spacing_deg;
    EXPECT_LT(*noise.deviation(), 0.004) << spacing_deg;  // A bin is that wide.
  }
}

TEST(RangeNoise, IsThatOfTheRangesAtAnySpacing) {
  for (const double deviation : {0.02, 0.06, 0.12}) {
    for (const double spacing_deg : {0.25, 1.0, 2.5}) {
      Rng rng(7);
      RangeNoise noise;
      for (int i = 0; i < 10; ++i)
        noise.take_in(scan_of_room(spacing_deg, [&](double range) { return range + rng.normal(deviation); }));
      EXPECT_NEAR(*noise.deviation(), deviation, 0.15 * deviation) << spacing_deg;
    }
  }
}

TEST(RangeNoise, ReadingsThatAreAnythingHardlyCount) {
  Rng rng(7);
  RangeNoise noise;
  for (int i = 0; i < 10; ++i) {
    noise.take_in(scan_of_room(1.0, [&](double range) {
      return rng.uniform() < 0.3 ? 0.3 + 5.0 * rng.uniform() : range + rng.normal(0.02);
    }));
  }
  EXPECT_NEAR(*noise.deviation(), 0.03, 0.012);
}

TEST(RangeNoise, IsAQuantileOfTheDistancesToTheLine) {
  // The middle one of three hits is 12.5 mm behind the line through the others: all are a quarter into the
  // third bin of 5 mm, as far as one can tell. A quarter of all distances of a normal distribution are below
  // 0.3186 standard deviations, and that of a hit to the mean of two others is sqrt(1.5) times its own.
  RangeNoise noise;
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(noise.deviation().has_value(), i >= 30) << i;
    Scan scan;
    scan.hits.push_back(hit_at(4.0 / std::cos(radians(1.0)), radians(-1.0)));
    scan.hits.push_back(hit_at(4.0125, 0.0));
    scan.hits.push_back(hit_at(4.0 / std::cos(radians(1.0)), radians(1.0)));
    noise.take_in(scan);
  }
  EXPECT_NEAR(*noise.deviation(), 0.005 * 2.25 / (0.3186 * std::sqrt(1.5)), 1e-4);
}

TEST(RangeNoise, IsNotToldByBeamsFarApartOrByTheSensorItself) {
  RangeNoise noise;
  for (int i = 0; i < 100; ++i) noise.take_in(scan_of_room(5.0, [](double range) { return range; }));
  EXPECT_FALSE(noise.deviation());
  Scan at_the_sensor;
  for (int i = 0; i < 100; ++i) at_the_sensor.hits.push_back({0.0F, 0.0F, 0.0F});
  noise.take_in(at_the_sensor);
  EXPECT_FALSE(noise.deviation());
}

}  // namespace
}  // namespace glocal::range_noise_test
