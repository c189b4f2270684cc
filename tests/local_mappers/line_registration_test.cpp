#include "local_mappers/line_registration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "local_mappers/rooms.hpp"
#include "local_mappers/scan_normals.hpp"
#include "points.hpp"

namespace glocal::local_mappers::line_registration_test {
namespace {

/// A map made of one scan at the origin, each hit a point of its own.
struct ScanMap {
  PointGrid grid{0.05, 9, 0.1, 1000};
  LocalMap map;

  explicit ScanMap(const Scan& scan) {
    const Points normals = scan_normals(scan.hits, scan.origin, {});
    for (std::size_t i = 0; i < scan.hits.size(); ++i) {
      const Point p = scan.hits[i];
      if (grid.inside(grid.cell(p.x, p.y)) != PointGrid::none) continue;
      EXPECT_TRUE(grid.insert(grid.cell(p.x, p.y), map.points.size()));
      map.points.push_back(p);
      map.normals.push_back(normals[i]);
    }
  }
};

TEST(LineRegistration, OneMatchByHand) {
  ScanMap world(Scan{});
  world.map.points.push_back({2.0F, 0.0F, 0.0F});
  world.map.normals.push_back({-1.0F, 0.0F, 0.0F});
  ASSERT_TRUE(world.grid.insert(world.grid.cell(2.0F, 0.0F), 0));
  const Points hits = test::points_of({{2.1F, 0.2F, 0.0F}});
  const Points normals = test::points_of({{-1.0F, 0.0F, 0.0F}});
  // c = 0.45 * 0.333 = 0.14985; r = -0.1; share = 0.02245502 / (0.02245502 + 0.01).
  const NormalEquations e = linearise(world.grid, world.map, hits, normals, {}, 0.45);
  EXPECT_EQ(e.matches, 1);
  const double share = 0.6918813;
  EXPECT_NEAR(e.cost, 0.5 * share * 0.01, 1e-7);
  // Derivatives of r: (-1, 0, n . (-y, x)) = (-1, 0, 0.2).
  EXPECT_NEAR(e.gradient.x(), 0.1 * share * share, 1e-6);
  EXPECT_NEAR(e.gradient.y(), 0.0, 1e-9);
  EXPECT_NEAR(e.gradient.z(), -0.1 * 0.2 * share * share, 1e-6);
  EXPECT_NEAR(e.hessian(0, 0), share * share, 1e-6);
  EXPECT_NEAR(e.hessian(0, 2), -0.2 * share * share, 1e-6);
  EXPECT_NEAR(e.hessian(2, 2), 0.04 * share * share, 1e-6);
  EXPECT_NEAR(e.hessian(1, 1), 0.0, 1e-9);
}

TEST(LineRegistration, MatchesNeedTheGateAndTheNormals) {
  ScanMap world(Scan{});
  world.map.points.push_back({2.0F, 0.0F, 0.0F});
  world.map.normals.push_back({-1.0F, 0.0F, 0.0F});
  ASSERT_TRUE(world.grid.insert(world.grid.cell(2.0F, 0.0F), 0));
  const Points hits = test::points_of({{2.2F, 0.0F, 0.0F}});
  const auto matches = [&](double normal_angle, double robot_x) {
    Points normals;
    normals.push_back(
        {static_cast<float>(-std::cos(normal_angle)), static_cast<float>(std::sin(normal_angle)), 0});
    return linearise(world.grid, world.map, hits, normals, {robot_x, 0, 0}, 0.25).matches;
  };
  EXPECT_EQ(matches(radians(59), 0.0), 1);
  EXPECT_EQ(matches(radians(61), 0.0), 0);
  EXPECT_EQ(matches(0.0, 0.04), 1);
  EXPECT_EQ(matches(0.0, 0.06), 0);
}

TEST(LineRegistration, TheGradientIsTheNumericDerivativeOfTheCost) {
  Rng rng(3);
  const Scan scan = test::scan_from(test::furnished_room(), {2, 2, 0.3}, {.noise = 0.01}, rng);
  const ScanMap world(scan);
  // A few hits without normals, so that both kinds of residual take part.
  Points normals = scan_normals(scan.hits, {}, {});
  for (std::size_t i = 0; i < normals.size(); i += 7) normals.set(i, {});
  // A wide gate, so that no match is lost within the differences; these are taken where a match may change
  // only for few.
  constexpr double gate = 0.45;
  const Pose2 pose{0.013, -0.021, 0.017};
  const auto cost = [&](double dx, double dy, double dt) {
    return linearise(world.grid, world.map, scan.hits, normals, {pose.x + dx, pose.y + dy, pose.theta + dt},
                     gate)
        .cost;
  };
  const NormalEquations e = linearise(world.grid, world.map, scan.hits, normals, pose, gate);
  ASSERT_GT(e.matches, 300);
  const double h = 5e-5;
  const Eigen::Vector3d numeric{(cost(h, 0, 0) - cost(-h, 0, 0)) / (2 * h),
                                (cost(0, h, 0) - cost(0, -h, 0)) / (2 * h),
                                (cost(0, 0, h) - cost(0, 0, -h)) / (2 * h)};
  EXPECT_LT((numeric - e.gradient).norm(), 0.05 * e.gradient.norm()) << numeric << "\n\n" << e.gradient;
}

TEST(LineRegistration, BringsAScanBackOntoItself) {
  Rng rng(3);
  const Scan scan = test::scan_from(test::furnished_room(), {2, 2, 0.3}, {}, rng);
  const ScanMap world(scan);
  const Points normals = scan_normals(scan.hits, {}, {});
  const ScanRegistration found =
      register_scan(world.grid, world.map, scan.hits, normals, {0.05, -0.04, 0.03}, 0.45);
  EXPECT_NEAR(found.local_from_robot.x, 0.0, 2e-3);
  EXPECT_NEAR(found.local_from_robot.y, 0.0, 2e-3);
  EXPECT_NEAR(found.local_from_robot.theta, 0.0, 1e-3);
  EXPECT_GT(found.matches, 300);
}

TEST(LineRegistration, ABareCorridorLeavesTheWayAlongItAlone) {
  Rng rng(3);
  const Scan scan = test::scan_from(test::bare_corridor(), {0, 0, 0}, {.max_range = 8.0}, rng);
  const ScanMap world(scan);
  const Points normals = scan_normals(scan.hits, {}, {});
  const ScanRegistration found =
      register_scan(world.grid, world.map, scan.hits, normals, {0.1, 0.05, 0.02}, 0.45);
  EXPECT_NEAR(found.local_from_robot.x, 0.1, 0.01);
  EXPECT_NEAR(found.local_from_robot.y, 0.0, 2e-3);
  EXPECT_NEAR(found.local_from_robot.theta, 0.0, 1e-3);
}

TEST(LineRegistration, WithoutMatchesItStays) {
  const ScanMap world(Scan{});
  const Points hits = test::points_of({{1, 1, 0}});
  const ScanRegistration found = register_scan(world.grid, world.map, hits, hits, {0.1, 0.2, 0.3}, 0.45);
  EXPECT_EQ(found.local_from_robot, (Pose2{0.1, 0.2, 0.3}));
  EXPECT_EQ(found.matches, 0);
}

}  // namespace
}  // namespace glocal::local_mappers::line_registration_test
