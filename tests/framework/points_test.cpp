#include "glocal/points.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "glocal/extent.hpp"
#include "glocal/point_spread.hpp"
#include "glocal/pose3.hpp"
#include "glocal/rng.hpp"

namespace glocal::points_test {
namespace {

TEST(Moved, IsWhatEigenComputes) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const Eigen::Vector3d origin(4.0, -2.0, 1.5);
  const Eigen::Isometry3d expected = Eigen::Translation3d(origin) * Eigen::AngleAxisd(2.1, axis);
  const Pose3 pose({4.0, -2.0, 1.5}, exponential({2.1 * axis.x(), 2.1 * axis.y(), 2.1 * axis.z()}));
  Rng rng(1);
  Points points;
  for (int i = 0; i < 100; ++i) {
    const auto draw = [&] { return static_cast<float>(rng.uniform(-20.0, 20.0)); };
    const float x = draw();
    const float y = draw();
    points.push_back({x, y, draw()});
  }
  const Points there = moved(points, pose);
  ASSERT_EQ(there.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = expected * Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
    EXPECT_NEAR(there.x[i], p.x(), 1e-5);
    EXPECT_NEAR(there.y[i], p.y(), 1e-5);
    EXPECT_NEAR(there.z[i], p.z(), 1e-5);
  }
}

TEST(Moved, NothingIsMovedToNothing) {
  EXPECT_TRUE(moved({}, Pose2{1, 2, 3}).empty());
}

TEST(Extent, IsFromTheLowestToTheHighest) {
  const Extent extent = extent_of({1.0F, -2.0F, 0.5F});
  EXPECT_EQ(extent.low, -2.0F);
  EXPECT_EQ(extent.high, 1.0F);
  EXPECT_EQ(extent.length(), 3.0);
  EXPECT_EQ(extent.middle(), -0.5);
  EXPECT_EQ(extent_of({}).length(), 0.0);
}

TEST(PointSums, FindTheNormalOfAPlaneButNoneOfALineOrABall) {
  const Quaternion turn = exponential({0.3, -0.4, 0.5});
  Rng rng(1);
  PointSums<double> plane, line, ball;
  for (int i = 0; i < 1000; ++i) {
    const double x = rng.normal(1.0), y = rng.normal(1.0), z = rng.normal(1.0);
    const auto add = [&](PointSums<double>& sums, const Vector3& v) {
      const Vector3 p = turn * v;
      sums.add(p.x(), p.y(), p.z());
    };
    add(plane, {x, y, 0.01 * z});
    add(line, {x, 0.01 * y, 0.01 * z});
    add(ball, {x, y, z});
  }
  const auto normal = plane.plane_normal(0.05, 0.2);
  ASSERT_TRUE(normal.has_value());
  EXPECT_NEAR(std::abs(as_vector(*normal).dot(turn * Vector3::UnitZ())), 1.0, 1e-3);
  EXPECT_FALSE(line.plane_normal(0.05, 0.2).has_value());
  EXPECT_FALSE(ball.plane_normal(0.05, 0.2).has_value());
}

}  // namespace
}  // namespace glocal::points_test
