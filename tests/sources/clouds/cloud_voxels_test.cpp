#include "sources/clouds/cloud_voxels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "files.hpp"

namespace glocal::clouds::cloud_voxels_test {
namespace {

constexpr double nothing = std::numeric_limits<double>::infinity();

Cloud two_points() {
  Cloud cloud;
  cloud.points = {{1.0F, 3.25F}, {2.0F, 2.0F}, {-1.0F, 0.0F}};
  return cloud;
}

TEST(CloudVoxels, BeginWithTheFirstPoints) {
  const CloudVoxels voxels(two_points(), 0.5, "a.pcd");
  EXPECT_EQ(voxels.side(), 0.5);
  // Cubes begin at (1, 2, -1): the points are in the first and the fifth along x, the first and the third
  // along z.
  EXPECT_TRUE(voxels.is_occupied({1.4, 2.4, -0.6}));
  EXPECT_TRUE(voxels.is_occupied({3.1, 2.1, 0.4}));
  EXPECT_FALSE(voxels.is_occupied({1.6, 2.4, -0.6}));
  EXPECT_FALSE(voxels.is_occupied({0.9, 2.4, -0.6})) << "before the first";
  EXPECT_FALSE(voxels.is_occupied({1e300, 2.4, -0.6}));
  EXPECT_FALSE(voxels.is_occupied({std::nan(""), 2.4, -0.6}));
  EXPECT_EQ(voxels.centre_near({1.4, 2.4, -0.6}), (Vector3{1.25, 2.25, -0.75}));
  EXPECT_EQ(voxels.centre_near({0.9, 0.1, 9.0}), (Vector3{0.75, 0.25, 9.25})) << "where there is none";
  EXPECT_NEAR(voxels.ray_distance({0.0, 2.1, -0.9}, {1.0, 0.0, 0.0}, 5.0), 1.0, 1e-12);
  EXPECT_NEAR(voxels.ray_distance({0.0, 2.1, 0.1}, {1.0, 0.0, 0.0}, 5.0), 3.0, 1e-12);
  EXPECT_EQ(voxels.ray_distance({0.0, 2.1, 0.1}, {1.0, 0.0, 0.0}, 2.9), nothing);
  EXPECT_EQ(voxels.ray_distance({0.0, 2.1, -0.4}, {1.0, 0.0, 0.0}, 5.0), nothing);
}

TEST(CloudVoxels, OfAnOctreeAreItsVoxels) {
  Cloud cloud = two_points();
  cloud.voxel_size = 0.25;
  const CloudVoxels voxels(cloud, 0.5, "a.bt");
  EXPECT_EQ(voxels.side(), 0.25);
  for (const double off : {-0.12, 0.0, 0.12}) {
    EXPECT_TRUE(voxels.is_occupied({1.0 + off, 2.0 - off, -1.0 + off}));
    EXPECT_TRUE(voxels.is_occupied({3.25 - off, 2.0 + off, off}));
  }
  EXPECT_FALSE(voxels.is_occupied({1.13, 2.0, -1.0}));
  EXPECT_NEAR(voxels.ray_distance({0.0, 2.1, -0.9}, {1.0, 0.0, 0.0}, 5.0), 0.875, 1e-12);
  EXPECT_NEAR(voxels.ray_distance({0.0, 2.1, -0.1}, {1.0, 0.0, 0.0}, 5.0), 3.125, 1e-12);
}

TEST(CloudVoxels, AreNotTooMany) {
  Cloud cloud = two_points();
  cloud.points.push_back({9000.0F, 9000.0F, 90.0F});
  EXPECT_EQ(test::config_error("", [&] { static_cast<void>(CloudVoxels(cloud, 0.1, "a.pcd")); }),
            "a.pcd: error: its extent is more than 4000 million cubes of 0.1 m; cut it smaller, or, if it is "
            "no octree, raise cloud_voxel_size");
}

}  // namespace
}  // namespace glocal::clouds::cloud_voxels_test
