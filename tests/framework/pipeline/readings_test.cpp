#include "glocal/readings.hpp"

#include <gtest/gtest.h>

#include "glocal/pose2.hpp"

namespace glocal::readings_test {
namespace {

TEST(Readings, AreRangesAndAnglesFromTheSensor) {
  Scan scan;
  scan.origin = {1.0F, 2.0F, 0.0F};
  for (const Point& hit : {Point{4.0F, 6.0F, 0.0F}, Point{1.0F, 0.0F, 0.0F}}) scan.hits.push_back(hit);
  const auto readings = readings_of(scan);
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_DOUBLE_EQ(readings[0].range, 5.0);
  EXPECT_DOUBLE_EQ(readings[0].angle, std::atan2(4.0, 3.0));
  EXPECT_DOUBLE_EQ(readings[1].range, 2.0);
  EXPECT_DOUBLE_EQ(readings[1].angle, radians(-90.0));
}

TEST(Readings, OfADirectionAreTheirMean) {
  // Directions 0, 179 and 179: 0 to 2 degrees, and -2 to 0.
  const auto means =
      by_direction({{2.0, radians(0.5)}, {4.0, radians(1.5)}, {1.0, radians(-0.5)}, {3.0, radians(-1.0)}});
  ASSERT_TRUE(means[0] && means[179]);
  EXPECT_DOUBLE_EQ(means[0]->range, 3.0);
  EXPECT_NEAR(means[0]->angle, radians(1.0), 1e-12);
  EXPECT_DOUBLE_EQ(means[179]->range, 2.0);
  EXPECT_NEAR(means[179]->angle, radians(-0.75), 1e-12);
  EXPECT_EQ(std::count_if(means.begin(), means.end(), [](const auto& mean) { return mean.has_value(); }), 2);
}

TEST(Readings, BehindTheSensorHaveADirectionToo) {
  const auto means = by_direction({{1.0, radians(180.0)}, {1.0, radians(-180.0)}, {1.0, radians(179.0)}});
  ASSERT_TRUE(means[89] && means[90]);
  EXPECT_NEAR(means[89]->angle, radians(179.0), 1e-12);
}

}  // namespace
}  // namespace glocal::readings_test
