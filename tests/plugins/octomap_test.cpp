// plugins/octomap, as users have it: a plugin's strategies, chosen in YAML.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "files.hpp"
#include "glocal/builtin.hpp"
#include "glocal/yaml.hpp"
#include "loading/plugin_loader.hpp"
#include "octree_files.hpp"

namespace glocal::test::octomap_test {
namespace {

using testing::HasSubstr;

class Octomap : public testing::Test {
 protected:
  Octomap() {
    register_builtin_strategies(catalog_);
    PluginLoader(catalog_).load(GLOCAL_OCTOMAP_PLUGIN);
  }

  MapData load(const std::string& content, const std::string& params = "") {
    folder_.write("tree", content);
    return load_file("tree", params);
  }

  MapData load_file(const std::string& path, const std::string& params) {
    StrategyChoice choice = catalog_.map_sources.choose("octomap");
    read_yaml(folder_.write("params.yaml", "path: \"" + path + "\"\n" + params), *choice.params);
    return catalog_.map_sources.make(choice, {})->load();
  }

  std::string fault(const std::string& content, const std::string& params = "") {
    return config_error(folder_ / "", [&] { (void)load(content, params); });
  }

  TemporaryFolder folder_;
  Catalog catalog_;
};

TEST_F(Octomap, APlanHasACellForEachColumnOfVoxels) {
  // Voxels of 0.1 m: number 32768 reaches from 0 to 0.1 m.
  const MapData map = load(bt_file({{.x = 32770, .y = 32767},
                                    {.x = 32770, .y = 32767, .z = 32770},
                                    {.x = 32768, .y = 32768, .log_odds = -1.0F}},
                                   0.1));
  EXPECT_EQ(map.grid.width, 3);
  EXPECT_EQ(map.grid.height, 2);
  EXPECT_NEAR(map.grid.resolution, 0.1, 1e-9);
  EXPECT_EQ(map.grid.at(0.25, -0.05), Cell::occupied);
  EXPECT_EQ(map.grid.at(0.05, 0.05), Cell::free);
  EXPECT_EQ(map.grid.at(0.15, 0.05), Cell::unknown);
  ASSERT_EQ(map.points.size(), 1U);
  EXPECT_NEAR(map.points.x[0], 0.25, 1e-6);
  EXPECT_NEAR(map.points.y[0], -0.05, 1e-6);
  EXPECT_EQ(map.points.z[0], 0.0F);
}

TEST_F(Octomap, PointsInSpaceAreTheOccupiedVoxels) {
  const MapData map =
      load(bt_file({{}, {.z = 32778}, {.x = 32790, .log_odds = -1.0F}}, 0.1), "points: space\n");
  ASSERT_EQ(map.points.size(), 2U);
  EXPECT_NEAR(map.points.z[0], 0.05, 1e-6);
  EXPECT_NEAR(map.points.z[1], 1.05, 1e-6);
}

TEST_F(Octomap, InSpaceTheFreeVoxelsAreKnown) {
  const std::string tree =
      bt_file({{}, {.x = 32790, .log_odds = -1.0F}, {.x = 32767, .z = 32778, .log_odds = -1.0F}}, 0.1);
  const FreeVoxels free = load(tree, "points: space\n").free_voxels;
  EXPECT_TRUE(free.contains({2.25F, 0.05F, 0.05F}));
  EXPECT_TRUE(free.contains({-0.05F, 0.05F, 1.05F}));
  EXPECT_FALSE(free.contains({0.05F, 0.05F, 0.05F}));   // occupied
  EXPECT_FALSE(free.contains({-0.05F, 0.05F, 0.05F}));  // unknown
  EXPECT_FALSE(free.contains({2.25F, 0.05F, 0.15F}));
  const FreeVoxels low = load(tree, "points: space\nmax_height: 0.5\n").free_voxels;
  EXPECT_TRUE(low.contains({2.25F, 0.05F, 0.05F}));
  EXPECT_FALSE(low.contains({-0.05F, 0.05F, 1.05F}));
  // Turned to the left, and moved.
  const FreeVoxels turned = load(tree, "points: space\ntree_pose: [1, 2, 90]\n").free_voxels;
  EXPECT_TRUE(turned.contains({0.95F, 4.25F, 0.05F}));
  EXPECT_FALSE(turned.contains({2.25F, 0.05F, 0.05F}));
  EXPECT_TRUE(load(tree).free_voxels.empty());
}

TEST_F(Octomap, InSpaceThePlanIsFreeOverAFloor) {
  // A floor with a free voxel over it, a column without any, and a free voxel alone.
  const std::string tree = bt_file({{},
                                    {.z = 32770, .log_odds = -1.0F},
                                    {.x = 32769},
                                    {.x = 32769, .z = 32770},
                                    {.x = 32770, .log_odds = -1.0F}},
                                   0.1);
  EXPECT_EQ(load(tree).grid.cells, (PackedCells{Cell::occupied, Cell::occupied, Cell::free}));
  EXPECT_EQ(load(tree, "points: space\n").grid.cells, (PackedCells{Cell::free, Cell::occupied, Cell::free}));
}

TEST_F(Octomap, OnlyTheBandOfHeightsCounts) {
  const std::string tree = bt_file({{}, {.z = 32778}, {.x = 32769, .z = 32778, .log_odds = -1.0F}}, 0.1);
  const MapData low = load(tree, "max_height: 0.5\n");
  EXPECT_EQ(low.grid.cells, PackedCells{Cell::occupied});
  const MapData high = load(tree, "min_height: 0.5\n");
  EXPECT_EQ(high.grid.cells, (PackedCells{Cell::occupied, Cell::free}));
  EXPECT_THAT(fault(tree, "min_height: 2\n"), HasSubstr("no voxel between min_height and max_height"));
  EXPECT_THAT(fault(tree, "min_height: 2\nmax_height: 1\n"), HasSubstr("must be above min_height"));
}

TEST_F(Octomap, AColumnMayNeedSeveralVoxels) {
  const std::string tree = bt_file({{}, {.z = 32769}, {.x = 32769}, {.x = 32770, .log_odds = -1.0F}}, 0.1);
  const MapData map = load(tree, "min_voxels: 2\n");
  EXPECT_EQ(map.grid.cells, (PackedCells{Cell::occupied, Cell::unknown, Cell::free}));
  EXPECT_EQ(map.points.size(), 1U);
}

TEST_F(Octomap, ALargeLeafIsTakenApart) {
  // At depth 14 a leaf is four of the smallest wide.
  const MapData map = load(bt_file({{.depth = 14}}, 0.1), "points: space\n");
  EXPECT_EQ(map.points.size(), 64U);
  EXPECT_EQ(map.grid.width, 4);
  EXPECT_EQ(map.grid.height, 4);
  EXPECT_NEAR(*std::max_element(map.points.z.begin(), map.points.z.end()), 0.35, 1e-6);
}

TEST_F(Octomap, LargeLeavesAreRefusedBeforeTheyAreTakenApart) {
  // All of a tree in eight leaves, and one leaf of 4096 voxels a side.
  std::vector<TreeLeaf> eighths;
  for (int i = 0; i < 8; ++i)
    eighths.push_back({.x = (i & 1) << 15, .y = (i >> 1 & 1) << 15, .z = (i >> 2) << 15, .depth = 1});
  EXPECT_THAT(fault(bt_file(eighths, 0.1)), HasSubstr("covers more than 64 million cells"));
  for (const char* points : {"plan", "space"}) {
    const std::string params = std::string("points: ") + points + "\nmax_height: 1000\n";
    EXPECT_THAT(
        fault(bt_file({{.depth = 4}}, 0.1), params),
        HasSubstr("its occupied voxels have more than 2 GB as points; if it is the right file, cut it"));
    EXPECT_THAT(fault(bt_file({{.log_odds = -1.0F, .depth = 4}}, 0.1), params),
                HasSubstr("has free space in more than 4 million cubes of 8 voxels a side"));
  }
}

TEST_F(Octomap, ALargeLeafIsCutAtTheHeights) {
  const MapData map =
      load(bt_file({{.depth = 8}}, 0.1), "points: space\nmin_height: 0.11\nmax_height: 0.36\n");
  // Centres at 0.15, 0.25 and 0.35 m.
  EXPECT_EQ(map.points.size(), 3U * 256U * 256U);
  EXPECT_EQ(map.points.x.capacity(), map.points.size());
  EXPECT_NEAR(*std::min_element(map.points.z.begin(), map.points.z.end()), 0.15, 1e-6);
  EXPECT_NEAR(*std::max_element(map.points.z.begin(), map.points.z.end()), 0.35, 1e-6);
}

TEST_F(Octomap, TheTreeCanLieAnywhereInTheMap) {
  const MapData map = load(bt_file({{.x = 32778}}, 0.1), "tree_pose: [2.0, 3.0, 90.0]\n");
  // (1.05, 0.05), turned to (-0.05, 1.05).
  EXPECT_NEAR(map.points.x[0], 1.95, 1e-5);
  EXPECT_NEAR(map.points.y[0], 4.05, 1e-5);
  EXPECT_EQ(map.grid.at(1.95, 4.05), Cell::occupied);
}

TEST_F(Octomap, ProbabilitiesDecideInAFullTree) {
  // Log-odds of 0.6 are a probability of 0.646.
  const std::string tree =
      ot_file({{.log_odds = 0.6F}, {.x = 32769, .log_odds = 2.0F}, {.x = 32770, .log_odds = -2.0F}}, 0.1);
  EXPECT_EQ(load(tree).points.size(), 2U);
  EXPECT_EQ(load(tree, "occupied_above: 0.64\n").points.size(), 2U);
  EXPECT_EQ(load(tree, "occupied_above: 0.65\n").points.size(), 1U);
}

TEST_F(Octomap, WhatIsNoTreeIsRefused) {
  const std::string tree = bt_file({{}, {.x = 40000}}, 0.1);
  EXPECT_THAT(fault("just some text\n"), HasSubstr("tree: error: is no file of OctoMap"));
  EXPECT_THAT(fault(""), HasSubstr("is no file of OctoMap"));
  EXPECT_THAT(fault(tree.substr(0, 40)), HasSubstr("ends within its header"));
  EXPECT_THAT(fault(tree.substr(0, tree.size() - 1)), HasSubstr("is damaged: it ends before its nodes do"));
  std::string other = tree;
  other.replace(other.find("id OcTree"), 9, "id ColorT");
  EXPECT_THAT(fault(other), HasSubstr("a tree of kind 'ColorT'"));
  other = tree;
  other.replace(other.find("res 0.1"), 7, "res 0.0");
  EXPECT_THAT(fault(other), HasSubstr("has no resolution"));
  other = tree;
  other.replace(other.find("size "), 6, "size 9");
  EXPECT_THAT(fault(other), HasSubstr("another number of nodes"));
  EXPECT_THAT(fault(bt_file({{.log_odds = -1.0F}}, 0.1)), HasSubstr("nothing occupied"));
}

TEST_F(Octomap, EveryCutAndEveryByteGivesAMapOrAFault) {
  const std::string tree = ot_file({{}, {.x = 32800}, {.x = 32700, .log_odds = -1.0F}}, 0.1);
  for (std::size_t n = 0; n < tree.size(); ++n) EXPECT_NE(fault(tree.substr(0, n)), "") << n;
  for (std::size_t n = tree.find("data"); n < tree.size(); ++n) {
    std::string damaged = tree;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x55);
    EXPECT_NO_FATAL_FAILURE((void)fault(damaged)) << n;
  }
}

TEST_F(Octomap, TheSharedTreeIsAsLargeAsItsDescriptionSays) {
  const auto file = dataset("octomap/geb079.bt");
  if (file.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const MapData map = load_file(file, "");
  EXPECT_NEAR(map.grid.resolution, 0.08, 1e-9);
  EXPECT_NEAR(map.grid.width * 0.08, 39.0, 0.1);
  EXPECT_NEAR(map.grid.height * 0.08, 15.0, 0.1);
}

/// Numbers of voxels along x, y and z, in order.
std::vector<std::array<long, 3>> voxels_at(const Points& points, double side) {
  const auto number = [&](float centre) { return std::lround(centre / side - 0.5); };
  std::vector<std::array<long, 3>> voxels;
  for (std::size_t i = 0; i < points.size(); ++i)
    voxels.push_back({number(points.x[i]), number(points.y[i]), number(points.z[i])});
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

TEST_F(Octomap, WithoutThePluginATreeHasTheSameOccupiedVoxels) {
  const auto expect_same = [&](const std::string& path, double side) {
    StrategyChoice choice = catalog_.map_sources.choose("point_cloud");
    read_yaml(folder_.write("cloud.yaml", "path: \"" + path + "\"\n"), *choice.params);
    const MapData cloud = catalog_.map_sources.make(choice, {})->load();
    const MapData tree = load_file(path, "points: space\n");
    EXPECT_NEAR(cloud.resolution, tree.grid.resolution, 1e-9);
    EXPECT_EQ(voxels_at(cloud.points, side), voxels_at(tree.points, side)) << path;
  };
  folder_.write("tree", bt_file({{.depth = 13},
                                 {.x = 34000, .y = 31000, .z = 36000},
                                 {.x = 32000, .log_odds = -1.0F, .depth = 12},
                                 {.x = 31500, .y = 33333, .z = 30001, .depth = 15}},
                                0.25));
  expect_same("tree", 0.25);
  const auto file = dataset("octomap/geb079.bt");
  if (file.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  expect_same(file, 0.08);
}

/// What a robot at the origin sees in a square room of 8 m with somebody 2 m before it, or not.
Observation room(bool somebody) {
  constexpr double person_x = 2.0;
  constexpr double person_radius = 0.25;
  Observation observation;
  for (int i = 0; i < 360; ++i) {
    const double angle = radians(i);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    double range = 4.0 / std::max(std::abs(c), std::abs(s));
    const double aside = person_x * std::abs(s);
    if (somebody && c > 0.0 && aside < person_radius) {
      range = person_x * c - std::sqrt(person_radius * person_radius - aside * aside);
    }
    observation.scan.hits.push_back({static_cast<float>(range * c), static_cast<float>(range * s), 0.0F});
  }
  return observation;
}

std::ptrdiff_t points_at_the_person(const Points& points) {
  std::ptrdiff_t n = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    n += std::hypot(points.x[i] - 2.0, points.y[i]) < 0.5 ? 1 : 0;
  return n;
}

TEST_F(Octomap, PeopleFadeFromTheLocalMapAndWallsStay) {
  const auto octree = catalog_.local_mappers.make(catalog_.local_mappers.choose("octomap"), {});
  const auto keeps_all = catalog_.local_mappers.make(catalog_.local_mappers.choose("scan_matching"), {});
  for (LocalMapper* mapper : {octree.get(), keeps_all.get()}) {
    for (int step = 0; step < 3; ++step) mapper->add(room(true));
    EXPECT_GT(points_at_the_person(mapper->map().points), 5);
    for (int step = 0; step < 10; ++step) mapper->add(room(false));
  }
  EXPECT_GT(points_at_the_person(keeps_all->map().points), 5);
  EXPECT_EQ(points_at_the_person(octree->map().points), 0);
  const LocalMap& map = octree->map();
  EXPECT_GT(map.points.size(), 300U);
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    EXPECT_NEAR(std::max(std::abs(map.points.x[i]), std::abs(map.points.y[i])), 4.0, 0.02);
  }
  ASSERT_EQ(map.ends.size(), 13U);
  EXPECT_EQ(map.ends.back(), map.points.size());
  EXPECT_TRUE(std::is_sorted(map.ends.begin(), map.ends.end()));
}

TEST_F(Octomap, WhatTheTreeCannotHoldIsLeftOutWithoutAWord) {
  StrategyChoice choice = catalog_.local_mappers.choose("octomap");
  read_yaml(folder_.write("params.yaml", "resolution: 0.005\nposes: odometry\n"), *choice.params);
  const auto mapper = catalog_.local_mappers.make(choice, {});
  Observation observation = room(false);
  observation.scan.free_ends.push_back({200.0F, 0.0F, 0.0F});  // it reaches up to 164 m
  testing::internal::CaptureStderr();
  mapper->add(observation);
  observation.odom_from_robot.x = 200.0;
  mapper->add(observation);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(mapper->map().points.size(), 300U);
}

TEST_F(Octomap, TheLocalMapsFileReadsBackAsAMap) {
  const auto mapper = catalog_.local_mappers.make(catalog_.local_mappers.choose("octomap"), {});
  for (int step = 0; step < 3; ++step) mapper->add(room(false));
  const std::vector<MapFile> files = mapper->files();
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files.front().extension, "bt");
  const MapData read = load(files.front().content);
  const Points& points = mapper->map().points;
  EXPECT_EQ(read.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(read.grid.at(points.x[i], points.y[i]), Cell::occupied);
  EXPECT_EQ(read.grid.at(1.0, 1.0), Cell::free);
}

}  // namespace
}  // namespace glocal::test::octomap_test
