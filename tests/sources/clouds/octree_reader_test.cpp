#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "files.hpp"
#include "octree_files.hpp"
#include "sources/clouds/cloud_file.hpp"
#include "sources/clouds/cloud_formats.hpp"
#include "sources/clouds/point_cloud_map.hpp"

namespace glocal::clouds::octree_reader_test {
namespace {

using test::bt_file;
using testing::HasSubstr;

Cloud read(const std::string& content, const CloudOptions& options = {}) {
  return read_octree_cloud(content, "a.bt", options);
}

std::string fault(const std::string& content, const CloudOptions& options = {}) {
  return test::config_error("", [&] { static_cast<void>(read(content, options)); });
}

std::string octree(const std::string& nodes, int size) {
  return "# Octomap OcTree binary file\n# made by hand\n\nid OcTree\nsize " + std::to_string(size) +
         "\nres 0.5\ndata\n" + nodes;
}

std::string node(unsigned codes) {
  return {static_cast<char>(codes & 0xFFU), static_cast<char>(codes >> 8U)};
}

/// Inner nodes that are the first children of each other.
std::string first_children(int n) {
  std::string nodes;
  for (int i = 0; i < n; ++i) nodes += node(3);
  return nodes;
}

TEST(OctreeReader, ReadsTheVoxelAtTheOrigin) {
  // The last child of the root begins at the origin, and so do the first children below it; the last of them
  // are an occupied voxel, a free one along x and an occupied one along z.
  const Cloud cloud = read(octree(node(3U << 14U) + first_children(14) + node(2U | 1U << 2U | 2U << 8U), 19));
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], (Point{0.25F, 0.25F, 0.25F}));
  EXPECT_EQ(cloud.points[1], (Point{0.25F, 0.25F, 0.75F}));
  EXPECT_EQ(cloud.voxel_size, 0.5);
  EXPECT_TRUE(cloud.normals.empty());
  EXPECT_TRUE(cloud.times.empty());
}

TEST(OctreeReader, CountsVoxelsFromTheOriginBothWays) {
  const Cloud cloud = read(bt_file({{.x = 32767, .y = 32778, .z = 32700}}, 0.1), {.unit = 10.0});
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_NEAR(cloud.points.x[0], -0.5, 1e-5);
  EXPECT_NEAR(cloud.points.y[0], 10.5, 1e-5);
  EXPECT_NEAR(cloud.points.z[0], -67.5, 1e-5);
  EXPECT_NEAR(cloud.voxel_size, 1.0, 1e-12);
}

TEST(OctreeReader, FillsLargeLeaves) {
  // At depth 14 a leaf is four of the smallest wide.
  const Points points = read(bt_file({{.depth = 14}, {.x = 32772, .log_odds = -1.0F}}, 1.0)).points;
  ASSERT_EQ(points.size(), 64U);
  for (const auto* axis : {&points.x, &points.y, &points.z}) {
    for (const float centre : {0.5F, 1.5F, 2.5F, 3.5F})
      EXPECT_EQ(std::count(axis->begin(), axis->end(), centre), 16);
  }
}

TEST(OctreeReader, RefusesOtherTrees) {
  EXPECT_TRUE(is_octree(bt_file({{}}, 0.1)));
  EXPECT_TRUE(is_octree(test::ot_file({{}}, 0.1)));
  EXPECT_FALSE(is_octree("# .PCD v0.7\n"));
  EXPECT_EQ(fault(test::ot_file({{}}, 0.1)),
            "a.bt:1: error: is no binary tree of OctoMap, which begins with '# Octomap OcTree binary file'; "
            "convert one with probabilities (.ot) to .bt, or take the map source octomap, a plugin");
  const std::string tree = bt_file({{}}, 0.1);
  const auto with = [&](const std::string& line, const std::string& other) {
    std::string changed = tree;
    return changed.replace(changed.find(line), line.size(), other);
  };
  EXPECT_EQ(fault(with("id OcTree", "id ColorOcTree")),
            "a.bt:3: error: holds a tree of kind 'ColorOcTree'; only OcTree can be read: convert it with "
            "OctoMap's tools");
  for (const char* side : {"0", "-0.1", "nan", "inf", "", "1e999"})
    EXPECT_THAT(
        fault(with("res 0.100000", std::string("res ") + side)),
        HasSubstr("a.bt:5: error: res: '" + std::string(side) + "' is no side of a voxel, a number above 0"));
  EXPECT_EQ(fault(with("size 17", "size -1")), "a.bt:4: error: size: '-1' is no number of nodes");
  for (const char* line : {"id OcTree\n", "size 17\n", "res 0.100000\n"})
    EXPECT_EQ(fault(with(line, "")),
              "a.bt:5: error: the header has no line 'id', 'size' or 'res' before 'data'; get a fresh copy");
  EXPECT_EQ(fault(tree.substr(0, 60)),
            "a.bt: error: ends within its header, which needs a line 'data'; get a fresh copy");
  EXPECT_EQ(fault(octree("", 0)), "a.bt: error: has no occupied voxels; give another file");
  EXPECT_EQ(fault(bt_file({{.log_odds = -1.0F}}, 0.1)),
            "a.bt: error: has no occupied voxels; give another file");
  EXPECT_THAT(fault(with("res 0.100000", "res 1e9")), HasSubstr("has a coordinate of 5e+08 m"));
}

TEST(OctreeReader, NamesTheByteThatIsDamaged) {
  const std::size_t begin = octree("", 17).size();
  const auto at = [&](std::size_t byte) {
    return "a.bt: error: is damaged at byte " + std::to_string(begin + byte) + ": ";
  };
  EXPECT_EQ(fault(octree(first_children(3), 17)),
            at(6) + "the file ends after 3 of 17 nodes; get a fresh copy");
  EXPECT_EQ(fault(octree(first_children(3) + node(0), 17)),
            at(6) + "an inner node has no children; get a fresh copy");
  EXPECT_EQ(fault(octree(first_children(20), 20)), at(30) + "a node is deeper than 16; get a fresh copy");
  EXPECT_EQ(fault(octree(first_children(15) + node(2), 18)),
            "a.bt: error: is damaged: the header announces 18 nodes, but 17 follow up to byte " +
                std::to_string(begin + 32) + "; get a fresh copy");
}

TEST(OctreeReader, BoundsWhatLargeLeavesAre) {
  // Half a million voxels of 12 bytes are 6 MB; half of the tree along each axis is 3.5e13 voxels.
  const std::string tree = bt_file({{.depth = 10}, {.x = 40000, .depth = 10}}, 0.1);
  EXPECT_EQ(read(tree, {.max_size_gb = 0.0063}).points.size(), 2U * 64U * 64U * 64U);
  EXPECT_EQ(fault(tree, {.max_size_gb = 0.0062}),
            "a.bt: error: its occupied voxels have more than 0.0062 GB as points; if it is the right file, "
            "thin it out");
  EXPECT_THAT(fault(bt_file({{.depth = 1}}, 0.1)), HasSubstr("have more than 2 GB as points"));
}

TEST(OctreeReader, TakesNoMoreMemoryThanItsPoints) {
  const Points points = read(bt_file({{.depth = 12}, {.x = 40000}}, 0.1)).points;
  ASSERT_EQ(points.size(), 4097U);
  for (const auto* axis : {&points.x, &points.y, &points.z}) EXPECT_EQ(axis->capacity(), 4097U);
}

TEST(OctreeReader, RefusesEachCutAndReadsOrRefusesEachChange) {
  const std::string tree = bt_file({{}, {.x = 32800}, {.x = 32700, .log_odds = -1.0F}, {.z = 1}}, 0.1);
  ASSERT_EQ(read(tree).points.size(), 3U);
  for (std::size_t n = 0; n < tree.size(); ++n) EXPECT_NE(fault(tree.substr(0, n)), "") << n;
  for (std::size_t n = tree.find("data"); n < tree.size(); ++n) {
    for (const int change : {0x55, 0xAA, 0xFF}) {
      std::string damaged = tree;
      damaged[n] = static_cast<char>(damaged[n] ^ change);
      EXPECT_NO_FATAL_FAILURE(static_cast<void>(fault(damaged, {.max_size_gb = 0.01}))) << n;
    }
  }
}

TEST(OctreeReader, TheSharedTreeHasAsManyLeavesAsItsDescriptionSays) {
  const auto file = test::dataset("octomap/geb079.bt");
  if (file.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const Cloud cloud = read_cloud(file);
  EXPECT_NEAR(cloud.voxel_size, 0.08, 1e-12);
  // 143,729 leaves, some of them larger than a voxel.
  EXPECT_GE(cloud.points.size(), 143'729U);
  const auto extent = [](const std::vector<float>& axis) {
    const auto [low, high] = std::minmax_element(axis.begin(), axis.end());
    return *high - *low;
  };
  EXPECT_LT(extent(cloud.points.x), 39.0F);
  EXPECT_LT(extent(cloud.points.y), 15.0F);
  EXPECT_LT(extent(cloud.points.z), 3.1F);
}

TEST(OctreeReader, AMapOfAnOctreeHasItsResolution) {
  const test::TemporaryFolder folder;
  PointCloudMap::Params params;
  params.path = test::file_path(folder.write("map.bt", bt_file({{}, {.y = 32868}, {.z = 32868}}, 0.1)));
  std::vector<std::string> warnings;
  const SourceSetup setup{.warn = [&](const std::string& text) { warnings.push_back(text); }};
  const MapData map = PointCloudMap(params, setup).load();
  EXPECT_EQ(map.points.size(), 3U);
  EXPECT_NEAR(map.resolution, 0.1, 1e-12) << "not the spacing of its points, 10 m";
}

}  // namespace
}  // namespace glocal::clouds::octree_reader_test
