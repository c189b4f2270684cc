#include "glocal/moments.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "glocal/rng.hpp"

namespace glocal::moments_test {
namespace {

constexpr double pi = std::numbers::pi;

Hypothesis at(const Pose3& pose, std::size_t support = 1) {
  return {.map_from_local = {}, .map_from_robot = pose, .score = 0.7, .support = support};
}

Hypothesis at(double x, double y, double theta) {
  return at(Pose2{x, y, theta});
}

TEST(Moments, MeanAndVariancesByHand) {
  const Cluster c = make_cluster({at(1.0, 2.0, 0.1), at(9.0, 9.0, 1.0), at(3.0, 2.0, 0.3)}, {0, 2});
  EXPECT_DOUBLE_EQ(c.map_from_robot.x, 2.0);
  EXPECT_DOUBLE_EQ(c.map_from_robot.y, 2.0);
  EXPECT_NEAR(c.map_from_robot.heading(), 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(c.variance_x, 1.0);  // ((1 - 2)^2 + (3 - 2)^2) / 2
  EXPECT_DOUBLE_EQ(c.variance_y, 0.0);
  EXPECT_NEAR(c.variance_theta, 0.01, 1e-12);
  EXPECT_EQ(c.members, (std::vector<std::size_t>{0, 2}));
}

TEST(Moments, HeadingsAcrossTheSeam) {
  const Cluster c = make_cluster({at(0, 0, pi - 0.1), at(0, 0, -pi + 0.1)}, {0, 1});
  EXPECT_NEAR(std::abs(c.map_from_robot.heading()), pi, 1e-12);
  EXPECT_NEAR(c.variance_theta, 0.01, 1e-12);
}

TEST(Moments, InSpaceByHand) {
  // Three quarters of the weight at one place, and all turns about one axis, the map's y.
  const Cluster c = make_cluster(
      {at(Pose3({1, 2, 3}, exponential({0, 0.1, 0})), 3), at(Pose3({1, 2, 7}, exponential({0, 0.5, 0})))},
      {0, 1});
  EXPECT_NEAR(c.map_from_robot.z, 4.0, 1e-12);
  EXPECT_NEAR(rotation_between(c.map_from_robot, Pose3(exponential({0, 0.2, 0}))), 0.0, 1e-9);
  EXPECT_NEAR(c.variance_z, 0.75 * 1.0 + 0.25 * 9.0, 1e-12);
  EXPECT_NEAR(c.variance_about_y, 0.75 * 0.01 + 0.25 * 0.09, 1e-9);
  EXPECT_NEAR(c.variance_x, 0.0, 1e-12);
  EXPECT_NEAR(c.variance_y, 0.0, 1e-12);
  EXPECT_NEAR(c.variance_about_x, 0.0, 1e-12);
  EXPECT_NEAR(c.variance_theta, 0.0, 1e-12);
}

TEST(Moments, TheMeanRotationHasTheLeastSumOfSquaredAngles) {
  Rng rng(3);
  const auto direction = [&] {
    return Vector3(rng.normal(1.0), rng.normal(1.0), rng.normal(1.0)).normalized();
  };
  const Quaternion centre(Eigen::AngleAxisd(2.5, direction()));
  std::vector<Quaternion> rotations;
  std::vector<Hypothesis> hypotheses;
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < 30; ++i) {
    rotations.push_back(centre * Quaternion(Eigen::AngleAxisd(rng.normal(0.4), direction())));
    const Quaternion& q = rotations.back();
    // q and -q are the same rotation.
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    hypotheses.push_back(at(Pose3(Quaternion(sign * q.coeffs()))));
    members.push_back(i);
  }
  const Cluster c = make_cluster(hypotheses, members);
  const Quaternion& mean = c.map_from_robot.rotation;
  const auto sum_of_squares = [&](const Quaternion& from) {
    double sum = 0.0;
    for (const Quaternion& q : rotations) sum += std::pow(from.angularDistance(q), 2);
    return sum;
  };
  const double least = sum_of_squares(mean);
  for (int i = 0; i < 50; ++i)
    EXPECT_LT(least, sum_of_squares(mean * Quaternion(Eigen::AngleAxisd(0.01, direction()))));
  // The variances about the axes are that sum, cut in three.
  EXPECT_NEAR(c.variance_about_x + c.variance_about_y + c.variance_theta, least / 30.0, 1e-9);
}

TEST(Moments, VariancesOfRotationAreAboutTheMapsAxes) {
  // A robot that looks along the map's y and rolls to both sides turns about that axis.
  const Quaternion left = turn_about_z(pi / 2);
  const Cluster c = make_cluster(
      {at(Pose3(left * exponential({0.2, 0, 0}))), at(Pose3(left * exponential({-0.2, 0, 0})))}, {0, 1});
  EXPECT_NEAR(c.variance_about_y, 0.04, 1e-9);
  EXPECT_NEAR(c.variance_about_x, 0.0, 1e-9);
  EXPECT_NEAR(c.map_from_robot.heading(), pi / 2, 1e-9);
}

TEST(Moments, InThePlaneThoseOfSpaceAreNought) {
  const Cluster c = make_cluster({at(0, 1, 0.1), at(2, 3, -0.4)}, {0, 1});
  EXPECT_TRUE(c.map_from_robot.is_planar());
  EXPECT_EQ(c.variance_z, 0.0);
  EXPECT_EQ(c.variance_about_x, 0.0);
  EXPECT_EQ(c.variance_about_y, 0.0);
}

}  // namespace
}  // namespace glocal::moments_test
