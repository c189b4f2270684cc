#include "glocal/points.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

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

}  // namespace
}  // namespace glocal::points_test
