#include "report/map_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "points.hpp"

namespace glocal::test::map_points_test {
namespace {

TEST(MapPoints, AreSortedAndEachThereOnce) {
  EXPECT_EQ(map_points(points_at({{2, 0}, {1, 0.5F}, {2.0001F, 0}, {1, -0.5F}})).dump(),
            R"({"x":[1000,1000,2000],"y":[-500,500,0],"spacing_m":1})");
}

TEST(MapPoints, OnAGridLieItsSpacingApart) {
  Points points;
  for (int i = 0; i < 100; ++i) {
    points.push_back({0.03F * static_cast<float>(i), 7.0F, 0.0F});
    points.push_back({5.0F, 0.03F * static_cast<float>(i), 0.0F});
  }
  EXPECT_EQ(map_points(points)["spacing_m"], 0.03);
}

TEST(MapPoints, AnywhereLieTheMedianDistanceApart) {
  std::mt19937 random(2);
  std::vector<std::pair<float, float>> at;
  for (int i = 0; i < 301; ++i)
    at.emplace_back(0.001F * static_cast<float>(random() % 9000),
                    0.001F * static_cast<float>(random() % 9000));
  std::vector<double> nearest;
  for (const auto& [x, y] : at) {
    double least = 1e9;
    for (const auto& [other_x, other_y] : at) {
      if (x != other_x || y != other_y)
        least = std::min(least, std::hypot(double{x} - other_x, double{y} - other_y));
    }
    nearest.push_back(least);
  }
  std::sort(nearest.begin(), nearest.end());
  EXPECT_NEAR(map_points(points_at(at))["spacing_m"].get<double>(), nearest[150], 1e-6);
}

TEST(MapPoints, FarAwayAreToTheMillimetreToo) {
  EXPECT_EQ(map_points(points_at({{2, 0}, {1, 0.5F}}), {500'000.0, 4'649'776.0, 0.0}).dump(),
            R"({"x":[500001000,500002000],"y":[4649776500,4649776000],"spacing_m":1.118034})");
}

TEST(MapPoints, InSpaceHaveHeights) {
  const Points points = points_of({{1.0F, 2.0F, 0.5F}, {1.0F, 2.0F, -0.25F}});
  EXPECT_EQ(map_points(points).dump(),
            R"({"x":[1000,1000],"y":[2000,2000],"spacing_m":0.75,"z":[-250,500]})");
}

TEST(MapPoints, OfNoneOrOneAreNothingApart) {
  EXPECT_EQ(map_points({}).dump(), R"({"x":[],"y":[],"spacing_m":0})");
  EXPECT_EQ(map_points(points_at({{1, 1}})).dump(), R"({"x":[1000],"y":[1000],"spacing_m":0})");
}

}  // namespace
}  // namespace glocal::test::map_points_test
