#include "glocal/register_clouds.hpp"

#include <gtest/gtest.h>

#include "glocal/error.hpp"
#include "matchers/surfels/scanned_hall.hpp"

namespace glocal::test::register_clouds_test {
namespace {

const Pose3 here({5.0, 4.5, 1.2}, turn_about_z(0.3));
const Pose3 there({6.5, 3.0, 1.0}, exponential({0.1, -0.2, 2.0}));
const Pose3 upside_down({4.0, 5.5, 2.0}, exponential({2.9, 0.4, -0.6}));

TEST(RegisterClouds, FindsThePoseWhateverTheCloudIsTurnedBy) {
  for (const Pose3& other : {there, upside_down}) {
    const Registration result = register_clouds(scan_of(hall(), other), scan_of(hall(), here));
    ASSERT_TRUE(result.target_from_source);
    const Pose3 truth = inverse(here) * other;
    EXPECT_LT(distance(*result.target_from_source, truth), 0.05);
    EXPECT_LT(degrees(rotation_between(*result.target_from_source, truth)), 0.5);
    EXPECT_TRUE(result.is_match) << result.why;
    EXPECT_TRUE(result.sensors_known);
    EXPECT_GT(result.overlap, 0.5);
    EXPECT_LT(result.rmse, result.voxel_size / 2.0);
  }
}

// The pose itself, found once more, is no other pose.
TEST(RegisterClouds, TheNextBestPoseIsAnotherOne) {
  const Points source = scan_of(hall(), there), target = scan_of(hall(), here);
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    RegistrationOptions options;
    options.seed = seed;
    const Registration result = register_clouds(source, target, options);
    EXPECT_GT(result.lead, 0.2) << seed;
  }
}

TEST(RegisterClouds, TheSameSeedGivesTheSameBits) {
  const Points source = scan_of(hall(), there);
  const Points target = scan_of(hall(), here);
  const Registration first = register_clouds(source, target);
  const Registration again = register_clouds(source, target);
  EXPECT_EQ(first.target_from_source, again.target_from_source);
  EXPECT_EQ(first.score, again.score);
}

TEST(RegisterClouds, ACloudOfAnotherPlaceIsNoMatch) {
  const std::vector<Box> shed = {{{0.0, 0.0, 0.0}, {5.0, 3.0, 2.2}}, {{3.5, 0.0, 0.0}, {5.0, 0.6, 1.0}}};
  const Registration result =
      register_clouds(scan_of(shed, Pose3({1.5, 1.6, 1.1}, turn_about_z(1.0))), scan_of(hall(), here));
  EXPECT_FALSE(result.is_match) << result.why;
}

TEST(RegisterClouds, APlaneFixesNoPose) {
  Points plane;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j)
      plane.push_back({0.1F * static_cast<float>(i), 0.1F * static_cast<float>(j), 2.0F});
  }
  const Registration result = register_clouds(plane, scan_of(hall(), here));
  EXPECT_FALSE(result.is_match) << result.why;
  EXPECT_FALSE(result.target_from_source);
}

TEST(RegisterClouds, WorksWhereTheSensorsPlacesAreNotKnown) {
  // Two scans each, joined: what is behind others in one was seen in the other.
  const auto joined = [](const Pose3& frame, const Pose3& a, const Pose3& b) {
    Points all;
    for (const Pose3& pose : {a, b}) {
      const Points scan = scan_of(hall(), pose);
      const Pose3 frame_from_scan = inverse(frame) * pose;
      for (std::size_t i = 0; i < scan.size(); ++i) {
        const Vector3 p = frame_from_scan * Vector3{scan.x[i], scan.y[i], scan.z[i]};
        all.push_back(as_point(p));
      }
    }
    return all;
  };
  // Their frames begin in a corner behind a wall, from where nothing can be seen.
  const Pose3 corner({-3.0, -2.0, 0.0}, turn_about_z(0.2));
  const Pose3 other_corner({17.0, -4.0, -1.0}, exponential({0.5, 1.0, -1.5}));
  const Registration result =
      register_clouds(joined(corner, here, there), joined(other_corner, upside_down, here));
  ASSERT_TRUE(result.target_from_source);
  const Pose3 truth = inverse(other_corner) * corner;
  EXPECT_LT(degrees(rotation_between(*result.target_from_source, truth)), 1.0);
  const Vector3 middle = inverse(corner) * Vector3{7.0, 4.5, 2.0};
  EXPECT_LT((*result.target_from_source * middle - truth * middle).norm(), 0.1);
}

TEST(RegisterClouds, CloudsThatReachTooFarAreRefused) {
  Points far = scan_of(hall(), here);
  far.push_back({9e6F, -9e6F, 9e6F});
  EXPECT_THROW(static_cast<void>(register_clouds(far, far)), ConfigError);
}

}  // namespace
}  // namespace glocal::test::register_clouds_test
