#include "glocal/range_bias.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"

namespace glocal::range_bias_test {
namespace {

/// From anywhere in a room of 8 m x 6 m to its walls, a beam a degree, with errors of range as told.
template <class Error>
ReadingByDirection room(Error error) {
  std::vector<PolarReading> readings;
  for (double angle_deg = -179.5; angle_deg < 180.0; angle_deg += 1.0) {
    const double angle = radians(angle_deg), x = std::cos(angle), y = std::sin(angle);
    const double range = std::min((x > 0.0 ? 5.0 : -3.0) / x, (y > 0.0 ? 2.0 : -4.0) / y);
    readings.push_back({error(range), angle});
  }
  return by_direction(readings);
}

TEST(RangeBias, IsWhatWasAddedToEachRange) {
  for (const double added : {-0.3, 0.0, 0.2, 0.5}) {
    RangeBias bias;
    bias.take_in(room([&](double range) { return range + added; }));
    EXPECT_GE(bias.walls(), 4U) << "the room has as many";
    EXPECT_NEAR(bias.median().value_or(9.0), added, 0.0101) << "a bin is 1 cm";
  }
}

TEST(RangeBias, IsToldByNoisyRangesToo) {
  Rng rng(7);
  RangeBias bias;
  for (int i = 0; i < 30; ++i)
    bias.take_in(room([&](double range) { return range + 0.2 + rng.normal(0.01); }));
  EXPECT_NEAR(bias.median().value_or(9.0), 0.2, 0.03);
}

TEST(RangeBias, IsNotToldByAnotherScale) {
  // A room that is measured 10 % too long is another room with straight walls.
  RangeBias bias;
  bias.take_in(room([](double range) { return 1.1 * range; }));
  EXPECT_NEAR(bias.median().value_or(9.0), 0.0, 0.0101);
}

TEST(RangeBias, NeedsStraightWalls) {
  RangeBias bias;
  EXPECT_FALSE(bias.median());
  Rng rng(7);
  bias.take_in(room([&](double range) { return range + rng.normal(0.2); }));
  bias.take_in({});
  bias.take_in(by_direction({{0.0, 0.0}, {1.0, 0.1}}));
  EXPECT_EQ(bias.walls(), 0U);
  EXPECT_FALSE(bias.median());
}

TEST(RangeBias, IsNotToldByWhatIsRound) {
  for (const double radius : {0.4, 0.6, 1.0, 4.0}) {
    RangeBias bias;
    std::vector<PolarReading> readings;
    for (double angle_deg = -179.5; angle_deg < 180.0; angle_deg += 1.0)
      readings.push_back({radius, radians(angle_deg)});
    bias.take_in(by_direction(readings));
    EXPECT_EQ(bias.walls(), 0U) << radius;
  }
}

}  // namespace
}  // namespace glocal::range_bias_test
