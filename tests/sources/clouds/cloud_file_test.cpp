#include "sources/clouds/cloud_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"
#include "octree_files.hpp"
#include "sources/clouds/cloud_files.hpp"

namespace glocal::clouds::cloud_file_test {
namespace {

using test::bytes;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(CloudFile, IsKnownByWhatItBeginsWith) {
  const test::TemporaryFolder folder;
  const Points points = {{1.0F, 4.0F}, {2.0F, 5.0F}, {3.0F, 6.0F}};
  EXPECT_EQ(read_cloud(folder.write("a.bin", pcd(points))).points, points);
  EXPECT_EQ(read_cloud(folder.write("a",
                                    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty "
                                    "float y\nproperty float z\nend_header\n1 2 3\n4 5 6\n"))
                .points,
            points);
  EXPECT_EQ(read_cloud(folder.write("b.bin", bytes(1.0F, 2.0F, 3.0F, 0.5F, 4.0F, 5.0F, 6.0F, 0.5F))).points,
            points);
  EXPECT_EQ(read_cloud(folder.write("c.pcd", test::bt_file({{}}, 2.0))).points,
            (Points{{1.0F}, {1.0F}, {1.0F}}));
}

TEST(CloudFile, OfAnotherFormatIsRefused) {
  const test::TemporaryFolder folder;
  const auto fault = [&](const std::string& name, const std::string& content) {
    const auto file = folder.write(name, content);
    return test::config_error(folder.path(), [&] { static_cast<void>(read_cloud(file)); });
  };
  EXPECT_EQ(
      fault("a.xyz", "1 2 3\n"),
      "a.xyz: error: is neither a PCD file, a PLY file nor an octree (.bt) by its first line, nor a cloud of "
      "KITTI by its name (*.bin); convert it to one of them");
  EXPECT_EQ(fault("a.las", "LASF...."),
            "a.las: error: is a LAS file; convert it to PCD or PLY: pdal translate FILE.las FILE.ply");
  EXPECT_EQ(fault("a.bin", bytes(1.0F, 2.0F, 3.0F, 4.0F, 5.0F)),
            "a.bin: error: has 20 bytes, 4 more than 1 points of 16 bytes (x y z intensity, float32); get a "
            "fresh copy, or convert it to PCD if its points have other values");
  EXPECT_EQ(fault("b.bin", ""), "b.bin: error: has no points; give another file");
}

TEST(CloudFile, HasANameToGoBy) {
  for (const char* name : {"a.pcd", "a.ply", "0001.bin", "a.pcd.gz", "a.bin.xz"})
    EXPECT_TRUE(has_name_of_cloud(name));
  for (const char* name : {"map.bt", "poses.tum", "a.txt", "a.gz", "pcd"})
    EXPECT_FALSE(has_name_of_cloud(name));
}

/// Corners of a box.
Cloud box(float x, float y, float z) {
  Cloud cloud;
  for (int i = 0; i < 8; ++i)
    cloud.points.push_back({(i & 1) != 0 ? x : 0.0F, (i & 2) != 0 ? y : 0.0F, (i & 4) != 0 ? z : 0.0F});
  return cloud;
}

TEST(CloudRemarks, SayWhatIsOdd) {
  EXPECT_THAT(cloud_remarks(box(40.0F, 20.0F, 3.0F)), IsEmpty());
  EXPECT_THAT(cloud_remarks(box(4000.0F, 2000.0F, 300.0F)),
              ElementsAre("extends over 4000 m; if it is in millimetres, set unit to 0.001"));
  EXPECT_THAT(cloud_remarks(box(40.0F, 20.0F, 0.0F)), ElementsAre("all points lie in a plane"));
  EXPECT_THAT(cloud_remarks(box(0.0F, 20.0F, 0.0F)),
              ElementsAre("all points lie on a line, or in one place"));
  EXPECT_THAT(cloud_remarks(box(0.0F, 0.0F, 0.0F)), ElementsAre("all points lie on a line, or in one place"));
  Cloud far = box(40.0F, 20.0F, 3.0F);
  for (float& y : far.points.y) y += 5e6F;
  far.not_finite = 2;
  EXPECT_THAT(cloud_remarks(far),
              ElementsAre("2 of 10 points have no finite coordinates; they are left out",
                          "has points 5000020 m from the origin, where places are rounded to 0.5 m; move the "
                          "origin near the points"));
}

TEST(CloudRemarks, MeasureTheSpreadOfACloudThatIsTurned) {
  Points points;
  for (int row = 0; row < 10; ++row) {
    for (int i = 0; i < 10; ++i)
      points.push_back({static_cast<float>(i), static_cast<float>(row), static_cast<float>(i)});
  }
  const auto spreads = principal_spreads(points);
  EXPECT_NEAR(spreads[0], std::sqrt(2.0 * 8.25), 1e-9);
  EXPECT_NEAR(spreads[1], std::sqrt(8.25), 1e-9);
  EXPECT_NEAR(spreads[2], 0.0, 1e-6);
}

TEST(CloudFile, OfTheDatasetsIsRead) {
  const auto folder = test::dataset("lidar3d");
  if (folder.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const Cloud building = read_cloud(folder / "fr_079/map.pcd");
  EXPECT_EQ(building.points.size(), 401'373U);
  EXPECT_THAT(cloud_remarks(building), IsEmpty());
  EXPECT_EQ(read_cloud(folder / "new_college/map.pcd").points.size(), 536'458U);
  EXPECT_EQ(read_cloud(folder / "fr_079/drives/d0/000.pcd").points.size(), 4630U);
}

}  // namespace
}  // namespace glocal::clouds::cloud_file_test
