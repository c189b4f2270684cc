#include "local_mappers/plane_registration.hpp"

#include <gtest/gtest.h>

#include "local_mappers/scanned_room.hpp"

namespace glocal::local_mappers::plane_registration_test {
namespace {

constexpr MatchLimits limits{.match_distance = 1.0, .kernel = 0.2};

class PlaneRegistrationTest : public testing::Test {
 protected:
  /// A map in the frame of the hall, from scans made around `place`.
  PlaneRegistrationTest() {
    for (int i = 0; i < 10; ++i) {
      const Pose3 pose = Pose3(Pose2{5.0, 1.5, 0.3 * i}) * Pose3(Vector3{0.0, 0.0, 0.9 + 0.05 * i});
      const Scan scan = test::ring_scan(test::furnished_hall(), pose, 0.0, rng_);
      map_.add(moved(scan.hits, pose), at(pose), 0.0);
    }
  }
  static Point at(const Pose3& pose) {
    return {static_cast<float>(pose.x), static_cast<float>(pose.y), static_cast<float>(pose.z)};
  }

  Rng rng_{2};
  SurfaceMap map_{SurfaceMapParams{}};
};

TEST_F(PlaneRegistrationTest, FindsAllSixOfAPose) {
  const Pose3 truth({4.8, 1.7, 1.1}, exponential({0.03, -0.02, 0.4}));
  const Scan scan = test::ring_scan(test::furnished_hall(), truth, 0.0, rng_);
  const Pose3 start = truth * Pose3({0.1, -0.08, 0.06}, exponential({0.03, 0.02, -0.05}));
  const PlaneRegistration found = register_to_planes(map_, scan.hits, {}, start, limits);
  EXPECT_LT(distance(found.local_from_robot, truth), 0.01);
  EXPECT_LT(rotation_between(found.local_from_robot, truth), radians(0.2));
  EXPECT_GT(found.matches, scan.hits.size() * 9 / 10);
}

TEST_F(PlaneRegistrationTest, StaysWhereNothingIsNear) {
  const Pose3 start(Vector3{200.0, 0.0, 0.0});
  const Scan scan = test::ring_scan(test::furnished_hall(), Pose3(Vector3{5.0, 1.5, 1.0}), 0.0, rng_);
  const PlaneRegistration found = register_to_planes(map_, scan.hits, {}, start, limits);
  EXPECT_EQ(found.local_from_robot, start);
  EXPECT_EQ(found.matches, 0U);
}

TEST(PlaneRegistration, StaysInDirectionsThatNoPointDetermines) {
  Points floor;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j)
      floor.push_back({-1.95F + 0.1F * static_cast<float>(i), -1.95F + 0.1F * static_cast<float>(j), -0.98F});
  }
  SurfaceMap map{SurfaceMapParams{}};
  map.add(floor, {}, 0.0);
  Points inner;
  for (std::size_t i = 0; i < floor.size(); ++i)
    if (std::abs(floor.x[i]) < 1.0F && std::abs(floor.y[i]) < 1.0F) inner.push_back(floor[i]);
  const Pose3 start({0.2, -0.1, 0.05}, turn_about_z(0.1));
  const Pose3 found = register_to_planes(map, inner, {}, start, limits).local_from_robot;
  EXPECT_NEAR(found.z, 0.0, 1e-3);
  EXPECT_NEAR(found.x, 0.2, 1e-3);
  EXPECT_NEAR(found.y, -0.1, 1e-3);
  EXPECT_NEAR(found.heading(), 0.1, 1e-3);
}

TEST(PlaneRegistration, TakesNoSurfaceFromBehind) {
  Points wall;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j)
      wall.push_back({2.02F, -0.95F + 0.1F * static_cast<float>(i), -0.95F + 0.1F * static_cast<float>(j)});
  }
  SurfaceMap map{SurfaceMapParams{}};
  map.add(wall, {}, 0.0);
  EXPECT_EQ(register_to_planes(map, wall, {}, {}, limits).matches, wall.size());
  const Point beyond{4.0F, 0.0F, 0.0F};
  EXPECT_EQ(register_to_planes(map, wall, beyond, {}, limits).matches, 0U);
}

}  // namespace
}  // namespace glocal::local_mappers::plane_registration_test
