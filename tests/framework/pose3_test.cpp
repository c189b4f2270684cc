#include "glocal/pose3.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "glocal/motion_equations.hpp"
#include "glocal/rng.hpp"

namespace glocal::pose3_test {
namespace {

constexpr double pi = std::numbers::pi;

Eigen::Isometry3d eigen(const Pose3& pose) {
  return Eigen::Translation3d(pose.x, pose.y, pose.z) * pose.rotation;
}

/// Poses all over the place, turned by any angle.
std::vector<Pose3> random_poses(std::size_t n) {
  Rng rng(7);
  std::vector<Pose3> poses;
  const auto value = [&] { return rng.uniform(-3.0, 3.0); };
  while (poses.size() < n)
    poses.push_back({{value(), value(), value()}, exponential({value(), value(), value()})});
  return poses;
}

TEST(Pose3, ComposesAndInvertsAsEigen) {
  const std::vector<Pose3> poses = random_poses(20);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_TRUE(eigen(poses[i - 1] * poses[i]).isApprox(eigen(poses[i - 1]) * eigen(poses[i]), 1e-12));
    EXPECT_TRUE(eigen(inverse(poses[i])).isApprox(eigen(poses[i]).inverse(), 1e-12));
    const Vector3 v{1.0, 2.0, -3.0};
    EXPECT_TRUE((poses[i] * v).isApprox(eigen(poses[i]) * v, 1e-12));
  }
}

TEST(Pose3, LongChainsOfProductsKeepUnitLength) {
  Quaternion q = Quaternion::Identity();
  for (const Pose3& pose : random_poses(100000)) q = composed(q, pose.rotation);
  EXPECT_NEAR(q.norm(), 1.0, 1e-15);
}

TEST(Pose3, ExponentialAndLogarithmUndoEachOther) {
  for (const Vector3& v :
       {Vector3{0.3, -1.2, 2.0}, Vector3{1e-9, 2e-9, 0.0}, Vector3{0.0, 0.0, 0.0}, Vector3{0.0, 0.0, 3.1}}) {
    const Vector3 again = logarithm(exponential(v));
    EXPECT_NEAR((again - v).norm(), 0.0, 1e-12);
  }
}

TEST(Pose3, LogarithmTakesTheShortWay) {
  const Quaternion q = exponential({0.0, 0.0, 2.0 * pi - 0.5});
  EXPECT_NEAR(logarithm(q).z(), -0.5, 1e-12);
  EXPECT_NEAR(angle_of(q), 0.5, 1e-12);
}

TEST(Pose3, AnglesAreThoseOfTheAxes) {
  // Half a radian to the left, then the nose a tenth of a radian down.
  const Pose3 pose = Pose3{turn_about_z(0.5)} * Pose3{exponential({0.0, 0.1, 0.0})};
  EXPECT_NEAR(pose.heading(), 0.5, 1e-12);
  EXPECT_NEAR(pose.tilt(), 0.1, 1e-12);
  EXPECT_NEAR(rotation_between(pose, Pose2{0.0, 0.0, 0.5}), 0.1, 1e-12);
  EXPECT_NEAR(distance(pose, Pose3{Vector3{2.0, 3.0, 6.0}}), 7.0, 1e-12);
}

TEST(Pose3, PlanarPosesStayPlanarAndAreThoseOfPose2) {
  Rng rng(3);
  Pose2 planar;
  Pose3 in_space;
  for (int i = 0; i < 10000; ++i) {
    const Pose2 step{rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-pi, pi)};
    planar = i % 3 == 0 ? planar * inverse(step) : planar * step;
    in_space = i % 3 == 0 ? in_space * inverse(Pose3(step)) : in_space * step;
  }
  EXPECT_TRUE(in_space.is_planar());
  EXPECT_NEAR(in_space.x, planar.x, 1e-9);
  EXPECT_NEAR(in_space.y, planar.y, 1e-9);
  EXPECT_NEAR(wrap_angle(seen_from_above(in_space).theta - planar.theta), 0.0, 1e-9);
  EXPECT_NEAR(seen_from_above(Pose3(Pose2{0.0, 0.0, pi})).theta, pi, 1e-15);
}

TEST(MotionEquations, AStepUndoesASmallMotion) {
  const Pose3 there({0.02, -0.01, 0.03}, exponential({0.01, -0.02, 0.015}));
  const Pose3 start(Vector3{5.0, 1.0, -2.0});
  Rng rng(5);
  const auto draw = [&] { return Vector3(rng.normal(1.0), rng.normal(1.0), rng.normal(1.0)); };
  MotionEquations<double> equations;
  for (int i = 0; i < 100; ++i) {
    const Vector3 arm = 3.0 * draw();
    const Vector3 n = draw().normalized();
    const Vector3 turn = arm.cross(n);
    const double residual = n.dot(start * arm - start * (there * arm));
    equations.add({turn.x(), turn.y(), turn.z(), n.x(), n.y(), n.z()}, residual, 1.0);
  }
  const Pose3 found = stepped(start, equations.step(1e-9));
  EXPECT_LT(distance(found, start * there), 1e-3);
  EXPECT_LT(rotation_between(found, start * there), 1e-3);
}

}  // namespace
}  // namespace glocal::pose3_test
