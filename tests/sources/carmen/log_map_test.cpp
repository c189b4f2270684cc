#include "sources/carmen/log_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "files.hpp"

namespace glocal::carmen::log_map_test {
namespace {

std::string scan_at(double x, double y, const std::string& readings) {
  const std::string pose = std::to_string(x) + " " + std::to_string(y) + " 0 ";
  return "TRUEPOS " + pose + pose + "0 h 0\nFLASER " + readings + " " + pose + pose + "0 h 0\n";
}

LogMap::Params params_for(const std::filesystem::path& file) {
  LogMap::Params params;
  params.log.path = test::file_path(file);
  params.resolution = 0.5;
  params.min_hits = 2;
  return params;
}

std::size_t count(const OccupancyGrid& grid, Cell kind) {
  return static_cast<std::size_t>(std::count(grid.cells.begin(), grid.cells.end(), kind));
}

TEST(LogMap, CountsHitsAndFreesTheWay) {
  const test::TemporaryFolder folder;
  // Two beams, to the right and straight ahead; the robot at (0.25, 1.25). The beam to the right is too short
  // to say anything. Ahead there are two hits in the cell [2, 2.5[, one in the cell [2.5, 3[.
  auto params =
      params_for(folder.write("a.log", scan_at(0.25, 1.25, "2 0.01 1.8") + scan_at(0.25, 1.25, "2 0.01 2.1") +
                                           scan_at(0.25, 1.25, "2 0.01 2.5")));
  const MapData map = LogMap(params, {}).load();
  ASSERT_EQ(map.points.size(), 1U);
  EXPECT_NEAR(map.points[0].x, (2.05 + 2.35) / 2, 1e-5);
  EXPECT_NEAR(map.points[0].y, 1.25, 1e-5);
  EXPECT_EQ(map.grid.at(2.2, 1.2), Cell::occupied);
  EXPECT_EQ(map.grid.at(2.7, 1.2), Cell::unknown) << "one hit is too few, and no ray went on";
  for (const double x : {0.2, 0.7, 1.2, 1.7}) EXPECT_EQ(map.grid.at(x, 1.2), Cell::free);
  EXPECT_EQ(count(map.grid, Cell::free), 4U);
  EXPECT_EQ(map.path, (std::vector<Pose3>{Pose2{0.25, 1.25, 0.0}}));

  params.min_hits = 1;
  EXPECT_EQ(LogMap(params, {}).load().points.size(), 2U);
}

TEST(LogMap, BeginsAtOrBelowItsLowestPoint) {
  const test::TemporaryFolder folder;
  // 0.7 m * -45 is a hair above -31.5 m: the grid begins a cell before, at -32.2 m. The robot is the lowest
  // point, and its beam goes through the cells from -31.5 m to the one from -30.1 m, which it hits.
  const auto load = [&](double x, double y) {
    auto params =
        params_for(folder.write("a.log", scan_at(x, y, "2 0.01 1.8") + scan_at(x, y, "2 0.01 1.8")));
    params.resolution = 0.7;
    return LogMap(params, {}).load();
  };
  const MapData left = load(-31.5, 1.0);
  EXPECT_NEAR(left.grid.map_from_grid.x, -32.2, 1e-9);
  ASSERT_EQ(left.points.size(), 1U);
  EXPECT_NEAR(left.points[0].x, -29.7, 1e-5);
  for (const double x : {-31.0, -30.3}) EXPECT_EQ(left.grid.at(x, 1.0), Cell::free) << x;
  EXPECT_EQ(left.grid.at(-29.7, 1.0), Cell::occupied);
  const MapData low = load(1.0, -31.5);
  EXPECT_NEAR(low.grid.map_from_grid.y, -32.2, 1e-9);
  ASSERT_EQ(low.points.size(), 1U);
  EXPECT_NEAR(low.points[0].x, 2.8, 1e-5);
  EXPECT_NEAR(low.points[0].y, -31.5, 1e-5);
}

TEST(LogMap, OfADriveFarAwayIsHeldRelativeToAnOriginNearItsFirstPose) {
  const test::TemporaryFolder folder;
  const auto load = [&](double x, double y) {
    return LogMap(params_for(folder.write("a.log", scan_at(x + 0.25, y + 0.25, "2 0.01 1.8") +
                                                       scan_at(x + 0.75, y + 0.25, "2 0.01 1.3"))),
                  {})
        .load();
  };
  const MapData near = load(0.0, 0.0);
  const MapData far = load(500'000.0, 4'649'776.0);
  EXPECT_EQ(near.origin, Vector3(0, 0, 0));
  EXPECT_EQ(far.origin, Vector3(500'000, 4'649'776, 0));
  ASSERT_EQ(near.points.size(), 1U);
  EXPECT_NEAR(near.points.x[0], 2.05, 1e-6);
  EXPECT_EQ(far.points, near.points);
  EXPECT_EQ(far.path, near.path);
  EXPECT_EQ(far.grid.map_from_grid, near.grid.map_from_grid);
  EXPECT_EQ(far.grid.cells, near.grid.cells);
}

TEST(LogMap, ACellThatMostRaysPassIsFree) {
  const test::TemporaryFolder folder;
  std::string log = scan_at(0.25, 0.25, "2 0.01 2") + scan_at(0.25, 0.25, "2 0.01 2");
  for (int i = 0; i < 8; ++i) log += scan_at(0.25, 0.25, "2 0.01 4");
  auto params = params_for(folder.write("a.log", log));
  params.min_hit_share = 0.2;
  EXPECT_EQ(LogMap(params, {}).load().points.size(), 2U);
  params.min_hit_share = 0.21;
  const MapData map = LogMap(params, {}).load();
  ASSERT_EQ(map.points.size(), 1U);
  EXPECT_NEAR(map.points[0].x, 4.25, 1e-5);
  EXPECT_EQ(map.grid.at(2.25, 0.25), Cell::free);
}

TEST(LogMap, RaysThatMetNothingFreeTheWayAsFarAsTrusted) {
  const test::TemporaryFolder folder;
  auto params =
      params_for(folder.write("a.log", scan_at(0.25, 0.25, "2 1 81.8") + scan_at(0.25, 0.25, "2 1 81.8")));
  params.log.free_range = 2.0;
  const MapData map = LogMap(params, {}).load();
  EXPECT_EQ(map.grid.at(1.9, 0.25), Cell::free);
  EXPECT_EQ(map.grid.at(2.3, 0.25), Cell::unknown);
  EXPECT_EQ(map.grid.at(10.0, 0.25), Cell::unknown);
}

TEST(LogMap, UsesItsSegmentsOnly) {
  const test::TemporaryFolder folder;
  std::string log;
  for (int i = 0; i <= 10; ++i) {
    log += scan_at(i, 0, "2 0.01 0.4");
    log += scan_at(i, 0, "2 0.01 0.4");
  }
  auto params = params_for(folder.write("a.log", log));
  params.log.segments = {{0.0, 0.15}, {0.95, 1.0}};
  const MapData map = LogMap(params, {}).load();
  EXPECT_EQ(map.points.size(), 3U);
  EXPECT_EQ(map.path, (std::vector<Pose3>{Pose2{0, 0, 0}, Pose2{1, 0, 0}, Pose2{10, 0, 0}}));
}

TEST(LogMap, SaysWhyThereIsNoMap) {
  const test::TemporaryFolder folder;
  const auto message = [&](const LogMap::Params& params) {
    return test::config_error(params.log.path.resolved.parent_path(),
                              [&] { static_cast<void>(LogMap(params, {}).load()); });
  };
  EXPECT_EQ(
      message(params_for(folder.write("a.log", scan_at(0, 0, "2 1 1") + "FLASER 2 1 1 0 0 0 0 0 0 1 h 0\n"))),
      "a.log:3: error: this scan has no reference pose; a map needs a TRUEPOS line before each scan it is "
      "made from");
  EXPECT_EQ(message(params_for(folder.write("b.log", scan_at(0, 0, "2 1 1")))),
            "b.log: error: its map has no occupied cell; lower min_hits, or use more scans");
  EXPECT_EQ(message(params_for(folder.write("c.log", scan_at(0, 0, "2 1 1") + scan_at(1e7, 9e6, "2 1 1")))),
            "c.log: error: its map would have more than 64 million cells; raise resolution, lower max_range, "
            "or look for wrong reference poses");
}

struct MapFacts {
  const char* file;
  double width, height;  ///< m, as the datasets' description has them
};

class SharedLogMap : public testing::TestWithParam<MapFacts> {};

TEST_P(SharedLogMap, CoversTheAreaItsDescriptionSays) {
  const auto file = test::dataset(GetParam().file);
  if (file.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  LogMap::Params params;
  params.log.path = test::file_path(file);
  const MapData map = LogMap(params, {}).load();
  // Without the few points seen through windows and doors.
  const auto extent = [](std::vector<float> v) {
    std::sort(v.begin(), v.end());
    return static_cast<double>(v[v.size() - v.size() / 50] - v[v.size() / 50]);
  };
  EXPECT_NEAR(extent(map.points.x), GetParam().width, 0.1 * GetParam().width);
  EXPECT_NEAR(extent(map.points.y), GetParam().height, 0.1 * GetParam().height);
  EXPECT_GT(count(map.grid, Cell::free), 10 * map.points.size());
}

INSTANTIATE_TEST_SUITE_P(Datasets, SharedLogMap,
                         testing::Values(MapFacts{"intel/intel.log.xz", 28.7, 28.6},
                                         MapFacts{"fr079/fr079.log.xz", 37.5, 15.6}),
                         [](const auto& log) {
                           const std::string name = log.param.file;
                           return name.substr(0, name.find('/'));
                         });

}  // namespace
}  // namespace glocal::carmen::log_map_test
