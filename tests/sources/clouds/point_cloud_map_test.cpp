#include "sources/clouds/point_cloud_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"
#include "points.hpp"

namespace glocal::clouds::point_cloud_map_test {
namespace {

using testing::ElementsAre;

/// Points of a room's floor and a wall, 0.1 m apart.
Points corner() {
  Points points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      points.push_back({0.1F * static_cast<float>(i), 0.1F * static_cast<float>(j), 0.0F});
      points.push_back({0.1F * static_cast<float>(i), 0.0F, 0.1F * static_cast<float>(j + 1)});
    }
  }
  return points;
}

class PointCloudMapTest : public testing::Test {
 protected:
  MapData load() {
    const SourceSetup setup{.motion = motion_,
                            .warn = [&](const std::string& text) { warnings_.push_back(text); },
                            .note_input = [&](const auto& file) { inputs_.push_back(file.filename()); }};
    return PointCloudMap(params_, setup).load();
  }

  test::TemporaryFolder folder_;
  PointCloudMap::Params params_;
  Motion motion_ = Motion::planar;
  std::vector<std::string> warnings_;
  std::vector<std::string> inputs_;
};

TEST_F(PointCloudMapTest, HasThePointsAndTheirSpacing) {
  params_.path = test::file_path(folder_.write("map.pcd", pcd(corner())));
  const MapData map = load();
  EXPECT_EQ(map.points, corner());
  EXPECT_NEAR(map.resolution, 0.1, 1e-6);
  EXPECT_TRUE(map.grid.cells.empty());
  EXPECT_TRUE(map.path.empty());
  EXPECT_THAT(warnings_, testing::IsEmpty());
  EXPECT_THAT(inputs_, ElementsAre("map.pcd"));
}

TEST_F(PointCloudMapTest, FarAwayIsHeldRelativeToAnOriginNearItsFirstPoint) {
  motion_ = Motion::upright;
  params_.path = test::file_path(
      folder_.write("map.pcd",
                    "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 3\nHEIGHT 1\nDATA ascii\n"
                    "nan 1 2\n500000.25 -4649776.125 1600.5\n500001.375 -4649775.0625 1601\n"));
  params_.trajectory = test::file_path(folder_.write("map.tum", "0 500001 -4649775 1600 0 0 0 1\n"));
  MapData map = load();
  EXPECT_EQ(map.origin, Vector3(500'000, -4'649'776, 1601)) << "halves are rounded away from 0";
  EXPECT_THAT(map.points.x, ElementsAre(0.25F, 1.375F));
  EXPECT_THAT(map.points.y, ElementsAre(-0.125F, 0.9375F));
  EXPECT_THAT(map.points.z, ElementsAre(-0.5F, 0.0F));
  ASSERT_EQ(map.path.size(), 1U);
  EXPECT_EQ(map.path[0], Pose3(Vector3{1, 1, -1}));
  EXPECT_THAT(warnings_, ElementsAre(testing::HasSubstr("1 of 3 points have no finite coordinates"),
                                     testing::HasSubstr("all points lie on a line")))
      << "and nothing is rounded";

  // In the plane heights stay as they are.
  motion_ = Motion::planar;
  map = load();
  EXPECT_EQ(map.origin, Vector3(500'000, -4'649'776, 0));
  EXPECT_THAT(map.points.z, ElementsAre(1600.5F, 1601.0F));
}

TEST_F(PointCloudMapTest, TakesOnePointOfEachVoxel) {
  params_.path = test::file_path(folder_.write("map.pcd", pcd(corner())));
  params_.voxel_size = 0.5;
  const MapData map = load();
  EXPECT_EQ(map.resolution, 0.5);
  EXPECT_LT(map.points.size(), 50U);
}

TEST_F(PointCloudMapTest, KeepsTheFirstNormalOfEachVoxel) {
  params_.path = test::file_path(folder_.write(
      "map.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nend_header\n"
      "0.1 0 0 0 0 1\n0.2 0 0 0 0 -1\n3 0 0 0 1 0\n"));
  params_.voxel_size = 1.0;
  const MapData map = load();
  ASSERT_EQ(map.points.size(), 2U);
  ASSERT_EQ(map.normals.size(), 2U);
  EXPECT_EQ(map.normals[0], (Point{0.0F, 0.0F, 1.0F}));
  EXPECT_EQ(map.normals[1], (Point{0.0F, 1.0F, 0.0F}));
}

TEST_F(PointCloudMapTest, HasThePathOfItsRobot) {
  params_.path = test::file_path(folder_.write("map.pcd", pcd(corner())));
  params_.trajectory = test::file_path(folder_.write("map.tum", "0 1 2 3 0 0 0 1\n1 4 5 6 0 0 0 1\n"));
  const MapData map = load();
  ASSERT_EQ(map.path.size(), 2U);
  EXPECT_EQ(map.path[1].z, 6.0);
  EXPECT_THAT(inputs_, ElementsAre("map.pcd", "map.tum"));
}

TEST_F(PointCloudMapTest, WarnsOfMillimetresAndTakesThem) {
  Points points = corner();
  for (auto* axis : {&points.x, &points.y, &points.z}) {
    for (float& value : *axis) value *= 2000.0F;
  }
  params_.path = test::file_path(folder_.write("map.pcd", pcd(points)));
  static_cast<void>(load());
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_THAT(warnings_[0], testing::EndsWith("map.pcd: extends over 4000 m; if it is in millimetres, set "
                                              "unit to 0.001"));
  warnings_.clear();
  params_.unit = 0.001;
  EXPECT_NEAR(load().resolution, 0.2, 1e-6);
  EXPECT_THAT(warnings_, testing::IsEmpty());
}

TEST(TypicalSpacing, LooksPastPointsInTheSamePlace) {
  Points points;
  for (int i = 0; i < 10; ++i) {
    for (int copies = 0; copies < 3; ++copies) points.push_back({0.25F * static_cast<float>(i), 0.0F, 0.0F});
  }
  EXPECT_EQ(typical_spacing(points), 0.25);
  const Points one = test::points_of({{1.0F, 2.0F, 3.0F}});
  EXPECT_EQ(typical_spacing(one), 0.0);
}

TEST_F(PointCloudMapTest, OfTheDatasetsIsLoaded) {
  const auto file = test::dataset("lidar3d/fr_079/map.pcd");
  if (file.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  params_.path = test::file_path(file);
  const MapData map = load();
  EXPECT_EQ(map.points.size(), 401'373U);
  EXPECT_NEAR(map.resolution, 0.05, 1e-4);
}

}  // namespace
}  // namespace glocal::clouds::point_cloud_map_test
