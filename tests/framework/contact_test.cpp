#include "glocal/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "glocal/error.hpp"
#include "glocal/rng.hpp"
#include "test_world.hpp"

namespace glocal {
namespace {

double distance_to_nearest(const Points& points, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double dx = points.x[i] - p.x;
    const double dy = points.y[i] - p.y;
    const double dz = points.z[i] - p.z;
    least = std::min(least, std::sqrt(dx * dx + dy * dy + dz * dz));
  }
  return least;
}

/// Compares with brute force wherever the distance is not within half a voxel's diagonal of epsilon.
void expect_as_by_brute_force(const Points& points, double epsilon, double half_diagonal, bool spread_z) {
  const ContactGrid grid(points, epsilon);
  Rng rng(11);
  int in_contact = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point p{static_cast<float>(rng.uniform(-1.0, 9.0)), static_cast<float>(rng.uniform(-1.0, 10.0)),
                  spread_z ? static_cast<float>(rng.uniform(-1.0, 2.0)) : 0.0F};
    const double d = distance_to_nearest(points, p);
    if (std::abs(d - epsilon) <= half_diagonal + 1e-4) continue;
    ASSERT_EQ(grid.contact(p), d < epsilon) << p.x << ' ' << p.y << ' ' << p.z << " at " << d;
    in_contact += d < epsilon ? 1 : 0;
  }
  EXPECT_GT(in_contact, 100);
}

TEST(ContactGrid, AgreesWithBruteForceInThePlane) {
  const double epsilon = 0.1;
  expect_as_by_brute_force(testing::small_world_points(), epsilon, epsilon / 4.0 * std::sqrt(2.0) / 2.0,
                           false);
}

TEST(ContactGrid, AgreesWithBruteForceInSpace) {
  Points points;
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    points.push_back({static_cast<float>(rng.uniform(0.0, 8.0)), static_cast<float>(rng.uniform(0.0, 9.0)),
                      static_cast<float>(rng.uniform(0.0, 1.0))});
  }
  const double epsilon = 0.4;
  expect_as_by_brute_force(points, epsilon, epsilon / 4.0 * std::sqrt(3.0) / 2.0, true);
}

TEST(ContactGrid, PlanarMapTakesInHeightsWithinEpsilon) {
  Points points;
  points.push_back({1.0F, 1.0F, 0.5F});
  const ContactGrid grid(points, 0.1);
  EXPECT_TRUE(grid.contact({1.0F, 1.0F, 0.55F}));
  EXPECT_FALSE(grid.contact({1.0F, 1.0F, 0.65F}));
  EXPECT_FALSE(grid.contact({1.0F, 1.0F, 0.35F}));
}

TEST(ContactGrid, NothingFarAwayOrNotANumberIsInContact) {
  const ContactGrid grid(testing::small_world_points(), 0.1);
  constexpr float huge = 1e30F;
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {huge, -huge, nan, std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(grid.contact({value, 0.0F, 0.0F}));
    EXPECT_FALSE(grid.contact({0.0F, value, 0.0F}));
    EXPECT_FALSE(grid.contact({0.0F, 0.0F, value}));
  }
}

TEST(ContactGrid, EmptyHasNoContact) {
  EXPECT_FALSE(ContactGrid(Points{}, 0.1).contact({0.0F, 0.0F, 0.0F}));
}

TEST(ContactGrid, RefusesToFillTheMemory) {
  Points points;
  points.push_back({0.0F, 0.0F, 0.0F});
  points.push_back({1e6F, 1e6F, 0.0F});
  try {
    const ContactGrid grid(points, 0.01);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("larger contact_epsilon"), std::string::npos) << e.what();
  }
}

TEST(ContactGrid, IsSharedByThoseWhoAskForTheSameEpsilon) {
  const auto map = testing::small_world();
  EXPECT_EQ(ContactGrid::of(*map, 0.1), ContactGrid::of(*map, 0.1));
  EXPECT_NE(ContactGrid::of(*map, 0.1), ContactGrid::of(*map, 0.2));
}

}  // namespace
}  // namespace glocal
