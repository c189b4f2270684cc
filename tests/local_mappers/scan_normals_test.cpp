#include "local_mappers/scan_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "points.hpp"

namespace glocal::local_mappers::scan_normals_test {
namespace {

/// A straight wall: points every 5 cm from `start` in direction `angle`.
Points wall(Point start, double angle, int n) {
  Points points;
  for (int i = 0; i < n; ++i) {
    points.push_back({static_cast<float>(start.x + 0.05 * i * std::cos(angle)),
                      static_cast<float>(start.y + 0.05 * i * std::sin(angle)), 0.0F});
  }
  return points;
}

TEST(ScanNormals, AreAcrossAWallOfAnyDirectionAndFaceTheSensor) {
  for (int degree = 0; degree < 360; degree += 15) {
    const double angle = radians(degree);
    // A wall along `angle`, 2 m to the left of the sensor: its normal points to the right.
    const Point start{static_cast<float>(-2.0 * std::sin(angle)), static_cast<float>(2.0 * std::cos(angle)),
                      0.0F};
    const Points normals = scan_normals(wall(start, angle, 20), {}, {});
    ASSERT_EQ(normals.size(), 20U);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      EXPECT_NEAR(normals.x[i], std::sin(angle), 1e-4) << degree;
      EXPECT_NEAR(normals.y[i], -std::cos(angle), 1e-4) << degree;
    }
  }
}

TEST(ScanNormals, FaceASensorThatIsNotAtTheOrigin) {
  const Points hits = wall({1, 0, 0}, radians(90), 9);
  EXPECT_NEAR(scan_normals(hits, {0, 0, 0}, {}).x[4], -1.0, 1e-5);
  EXPECT_NEAR(scan_normals(hits, {2, 0, 0}, {}).x[4], 1.0, 1e-5);
}

TEST(ScanNormals, StayExactFarFromTheOrigin) {
  const Points normals = scan_normals(wall({500, 300, 0}, radians(45), 20), {}, {});
  EXPECT_NEAR(normals.x[10], -std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(normals.y[10], std::sqrt(0.5), 1e-3);
}

TEST(ScanNormals, DoNotReachAcrossAJump) {
  Points hits = wall({2, 0, 0}, radians(90), 5);
  const Points behind = wall({4, 0.25F, 0}, radians(90), 5);
  for (std::size_t i = 0; i < behind.size(); ++i) hits.push_back(behind[i]);
  const Points normals = scan_normals(hits, {}, {.beams = 4, .max_roughness = 0.1});
  for (std::size_t i = 0; i < hits.size(); ++i) EXPECT_NEAR(normals.x[i], -1.0, 1e-5) << i;
}

TEST(ScanNormals, AreMissingWhereNothingIsALine) {
  const Points pair = test::points_of({{1, 0, 0}, {1, 0.05F, 0}});
  EXPECT_EQ(scan_normals(pair, {}, {})[0], Point{});
  Points same;
  for (int i = 0; i < 5; ++i) same.push_back({1, 1, 0});
  EXPECT_EQ(scan_normals(same, {}, {})[2], Point{});
  Points square;
  for (const auto& [x, y] : {std::pair{1.0F, 0.0F}, {1.1F, 0.0F}, {1.1F, 0.1F}, {1.0F, 0.1F}}) {
    square.push_back({x, y, 0});
  }
  EXPECT_EQ(scan_normals(square, {}, {})[1], Point{});
  EXPECT_TRUE(scan_normals({}, {}, {}).empty());
}

TEST(ScanNormals, BisectACorner) {
  // Four hits on each leg of a right angle: the line through all of them has slope -1.
  Points hits;
  for (int i = 4; i >= 0; --i) hits.push_back({0.0F, 1.0F - 0.05F * static_cast<float>(i), 0.0F});
  for (int i = 1; i <= 4; ++i) hits.push_back({-0.05F * static_cast<float>(i), 1.0F, 0.0F});
  const Points normals = scan_normals(hits, {-1, 0, 0}, {.beams = 4, .max_roughness = 1.0});
  EXPECT_NEAR(normals.x[4], -std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(normals.y[4], -std::sqrt(0.5), 1e-4);
}

}  // namespace
}  // namespace glocal::local_mappers::scan_normals_test
