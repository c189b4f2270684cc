#include "sources/clouds/cloud_drive_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"
#include "glocal/yaml.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::clouds::cloud_drive_map_test {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

class CloudDriveMapTest : public testing::Test {
 protected:
  CloudDriveMapTest() {
    params_.drive.folder = test::file_path(folder_.path());
    params_.resolution = 0.5;
  }

  void write_cloud(int number, const std::vector<Point>& points) {
    Points cloud;
    for (const Point& p : points) cloud.push_back(p);
    folder_.write(std::to_string(number) + ".pcd", pcd(cloud));
  }
  FilePath write_poses(const std::string& name, const std::string& text) {
    return test::file_path(folder_.write(name, text));
  }
  [[nodiscard]] MapData load() const { return CloudDriveMap(params_, {}).load(); }
  [[nodiscard]] std::string fault() const {
    return test::config_error(folder_ / "", [&] { static_cast<void>(load()); });
  }

  test::TemporaryFolder folder_;
  CloudDriveMap::Params params_;
};

TEST_F(CloudDriveMapTest, HasTheMeanOfWhatEachCubeWasHitBy) {
  // Two looks at a place at (2.1, 0.2, 1.1), from the origin and, turned to the left, from (2, -1, 1).
  write_cloud(0, {{2.1F, 0.2F, 1.1F}, {1.0F, 0.0F, 0.0F}});
  write_cloud(1, {{1.2F, -0.2F, 0.2F}});
  params_.drive.reference =
      write_poses("poses.tum", "0 0 0 0 0 0 0 1\n1 2 -1 1 0 0 0.70710678118 0.70710678118\n");
  const MapData map = load();
  EXPECT_THAT(map.points.x, Pointwise(FloatNear(1e-5F), {2.15F, 1.0F}));
  EXPECT_THAT(map.points.y, Pointwise(FloatNear(1e-5F), {0.2F, 0.0F}));
  EXPECT_THAT(map.points.z, Pointwise(FloatNear(1e-5F), {1.15F, 0.0F}));
  EXPECT_EQ(map.resolution, 0.5);
  EXPECT_TRUE(map.grid.cells.empty());
  EXPECT_EQ(map.path.size(), 2U);
  params_.min_clouds = 2;
  EXPECT_EQ(load().points.size(), 1U);
  params_.min_clouds = 3;
  EXPECT_THAT(fault(), HasSubstr("its map has no point; lower min_clouds, raise max_range"));
}

TEST_F(CloudDriveMapTest, FarAwayIsHeldRelativeToAnOriginNearItsFirstPose) {
  write_cloud(0, {{2.1F, 0.2F, 1.1F}});
  write_cloud(1, {{1.0F, 0.0F, 0.0F}});
  params_.drive.reference =
      write_poses("poses.tum", "0 500000.25 4649776 1500 0 0 0 1\n1 500010 4649776.125 1499.5 0 0 0 1\n");
  const MapData map = CloudDriveMap(params_, {.motion = Motion::free}).load();
  EXPECT_EQ(map.origin, Vector3(500'000, 4'649'776, 1500));
  EXPECT_THAT(map.points.x, Pointwise(FloatNear(1e-6F), {2.35F, 11.0F}));
  EXPECT_THAT(map.points.y, Pointwise(FloatNear(1e-6F), {0.2F, 0.125F}));
  EXPECT_THAT(map.points.z, Pointwise(FloatNear(1e-6F), {1.1F, -0.5F}));
  ASSERT_EQ(map.path.size(), 2U);
  EXPECT_EQ(map.path[1], Pose3(Vector3{10, 0.125, -0.5}));
}

TEST_F(CloudDriveMapTest, TakesTheSegmentsThatItIsGiven) {
  std::string poses;
  for (int i = 0; i <= 10; ++i) {
    write_cloud(i, {{0.0F, 1.0F, 0.25F}});
    poses += std::to_string(i) + " " + std::to_string(i) + ".25 0 0 0 0 0 1\n";
  }
  params_.drive.reference = params_.drive.odometry = write_poses("poses.tum", poses);
  params_.drive.segments = {{0.0, 0.25}, {0.8, 1.0}};
  EXPECT_THAT(load().points.x, ElementsAre(0.25F, 1.25F, 2.25F, 8.25F, 9.25F, 10.25F));
  CloudDrive drive(params_.drive, {});
  std::multiset<int> segments;
  while (const auto sample = drive.next()) segments.insert(sample->segment);
  EXPECT_EQ(segments, (std::multiset<int>{0, 0, 0, 1, 1, 1}));
  params_.drive.segments = {{0.01, 0.02}};
  EXPECT_THAT(fault(), HasSubstr("has no cloud between 0.01 and 0.02 of its path; widen the segment"));
}

TEST_F(CloudDriveMapTest, NeedsReferencePoses) {
  write_cloud(0, {{2.0F, 0.0F, 0.0F}});
  write_cloud(1, {{3.0F, 0.0F, 0.0F}});
  ParamsOf<CloudDriveMap::Params> params;
  const std::string file = folder_.write("map.yaml", "folder: " + folder_.path().string() + "\n");
  EXPECT_THAT(test::config_error(folder_ / "", [&] { read_yaml(file, params); }),
              HasSubstr("reference: must be given: a map needs to know where clouds lie"));
  // A cloud without one is left out.
  params_.drive.reference = write_poses("poses.tum", "1 0 0 0 0 0 0 1\n");
  EXPECT_THAT(load().points.x, ElementsAre(3.0F));
}

TEST_F(CloudDriveMapTest, OfADriveLiesOnTheMapThatItWasSimulatedIn) {
  const std::filesystem::path folder = test::dataset("lidar3d/fr_079");
  if (folder.empty() || !std::filesystem::exists(folder)) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  params_.drive.folder = test::file_path(folder / "drives/d0");
  params_.drive.reference = test::file_path(folder / "drives/d0/poses.tum");
  params_.resolution = 0.1;
  params_.min_clouds = 3;
  const MapData map = load();
  EXPECT_GT(map.points.size(), 5000U);
  // Cubes that the map has, too, or that neighbour on one.
  std::set<std::array<int, 3>> cubes;
  const Points whole = read_cloud(folder / "map.pcd", {}).points;
  const auto cube = [](const Point& p, int axis) {
    return static_cast<int>(std::floor((axis == 0 ? p.x : axis == 1 ? p.y : p.z) / 0.1F));
  };
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Point p = whole[i];
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) cubes.insert({cube(p, 0) + dx, cube(p, 1) + dy, cube(p, 2) + dz});
      }
    }
  }
  std::size_t near = 0;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Point p = map.points[i];
    near += cubes.contains({cube(p, 0), cube(p, 1), cube(p, 2)}) ? 1U : 0U;
  }
  EXPECT_GT(static_cast<double>(near), 0.98 * static_cast<double>(map.points.size()));
}

}  // namespace
}  // namespace glocal::clouds::cloud_drive_map_test
