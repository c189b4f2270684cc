#include "local_mappers/surface_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "glocal/rng.hpp"
#include "points.hpp"

namespace glocal::local_mappers::surface_map_test {
namespace {

using testing::ElementsAre;

Points random_points(int n, double half, Rng& rng) {
  Points points;
  for (int i = 0; i < n; ++i) {
    points.push_back({static_cast<float>(rng.uniform(-half, half)),
                      static_cast<float>(rng.uniform(-half, half)),
                      static_cast<float>(rng.uniform(-half, half))});
  }
  return points;
}

double apart(const Point& a, const Point& b) {
  return Vector3(double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z).norm();
}

/// A level square of 2 m around (0, 0, z), a hit every 10 cm.
Points level_square(float z) {
  Points points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j)
      points.push_back({-0.95F + 0.1F * static_cast<float>(i), -0.95F + 0.1F * static_cast<float>(j), z});
  }
  return points;
}

TEST(SurfaceMap, HoldsTheMeanOfACubesFirstHits) {
  SurfaceMap map({.resolution = 0.1, .cell_hits = 2, .normal_radius = 0.5});
  Points hits;
  for (const float x : {-0.01F, -0.03F, -0.09F, 0.01F}) hits.push_back({x, 0.05F, 0.05F});
  map.add(hits, {}, 0.0);
  map.add({}, {}, 0.0);
  ASSERT_THAT(map.map().ends, ElementsAre(2U, 2U));
  EXPECT_FLOAT_EQ(map.map().points.x[0], -0.02F);
  EXPECT_FLOAT_EQ(map.map().points.x[1], 0.01F);
}

TEST(SurfaceMap, FindsTheNearestPointAsBruteForceDoes) {
  Rng rng(3);
  SurfaceMap map({.resolution = 0.05, .normal_radius = 0.3});
  map.add(random_points(3000, 3.0, rng), {}, 0.0);
  const Points& points = map.map().points;
  const Points queries = random_points(500, 3.5, rng);
  for (const double within : {0.1, 0.3, 1.0}) {
    for (std::size_t q = 0; q < queries.size(); ++q) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < points.size(); ++i) least = std::min(least, apart(points[i], queries[q]));
      const auto found = map.nearest(queries[q], within);
      ASSERT_EQ(found.has_value(), least <= within);
      if (!found) continue;
      ASSERT_NEAR(apart(points[*found], queries[q]), least, 1e-6);
    }
  }
}

TEST(SurfaceMap, TurnsNormalsToWhereTheSensorWas) {
  for (const float height : {1.0F, -1.0F}) {
    SurfaceMap map(SurfaceMapParams{});
    map.add(level_square(0.02F), {0.0F, 0.0F, height}, 0.0);
    for (std::size_t i = 0; i < map.map().points.size(); ++i) {
      EXPECT_NEAR(map.map().normals.z[i], height, 1e-6);
      EXPECT_NEAR(map.map().normals.x[i], 0.0, 1e-6);
    }
  }
}

TEST(SurfaceMap, HasNoNormalsOnALine) {
  SurfaceMap map(SurfaceMapParams{});
  Points hits;
  for (int i = 0; i < 40; ++i) hits.push_back({0.1F * static_cast<float>(i), 0.02F, 0.02F});
  map.add(hits, {0.0F, 0.0F, 1.0F}, 0.0);
  for (std::size_t i = 0; i < map.map().points.size(); ++i) EXPECT_EQ(map.map().normals[i], Point{});
}

TEST(SurfaceMap, ForgetsByObservationsAndByWay) {
  SurfaceMap map({.resolution = 0.1, .normal_radius = 0.5});
  const auto hit = [](float x) { return test::points_of({{x, 0.05F, 0.05F}}); };
  map.add(hit(0.05F), {}, 0.0);
  map.add(hit(1.05F), {}, 1.0);
  map.add(hit(2.05F), {}, 2.0);
  map.add(hit(0.05F), {}, 3.0);  // Seen again: kept, where it was.
  map.forget(10, 1.5);
  EXPECT_THAT(map.map().points.x, ElementsAre(0.05F, 2.05F));
  EXPECT_THAT(map.map().ends, ElementsAre(1U, 1U, 2U, 2U));
  EXPECT_EQ(map.nearest({1.05F, 0.05F, 0.05F}, 0.2), std::nullopt);
  EXPECT_EQ(map.nearest({2.05F, 0.05F, 0.05F}, 0.2), 1U);
  map.add({}, {}, 3.0);
  map.add({}, {}, 3.0);
  map.forget(3, 0.0);
  EXPECT_THAT(map.map().points.x, ElementsAre(0.05F));
  map.forget(2, 0.0);
  EXPECT_TRUE(map.map().points.empty());
  EXPECT_THAT(map.map().ends, ElementsAre(0U));
}

TEST(SurfaceMap, LeavesOutWhatIsTooFarForSinglePrecision) {
  SurfaceMap map(SurfaceMapParams{});
  Points hits = test::points_of({{1e6F, 0.0F, 0.0F}, {1.0F, 0.0F, -5000.0F}, {1.0F, 0.0F, 0.0F}});
  map.add(hits, {}, 0.0);
  EXPECT_EQ(map.map().points.size(), 1U);
}

}  // namespace
}  // namespace glocal::local_mappers::surface_map_test
