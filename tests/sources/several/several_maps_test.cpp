// Maps side by side.
#include "sources/several/several_maps.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "files.hpp"
#include "framework/pipeline/fakes.hpp"

namespace glocal::several::several_maps_test {
namespace {

/// 3 x 2 cells of 0.5 m, one of them occupied: column 2 of row 0.
MapData small_map(const Pose2& corner) {
  MapData map;
  map.grid = {corner, 0.5, 3, 2, PackedCells(6, Cell::free)};
  map.grid.cell(2, 0) = Cell::occupied;
  map.points = occupied_centres(map.grid);
  map.path = {Pose2{corner.x + 0.25, corner.y + 0.25, 0.5}};
  return map;
}

MapData joined(std::vector<MapData> maps) {
  Registry<MapSource, SourceSetup> sources{"map_source"};
  SeveralMaps::Params params{.sources = &sources};
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::string name = "map_" + std::to_string(i);
    sources.add<test::GivenMap>(name, "A given map.", {}, {std::move(maps[i])});
    params.maps.push_back({&sources, "floor " + std::to_string(i), sources.choose(name)});
  }
  return SeveralMaps(params, SourceSetup{}).load();
}

std::string refused(std::vector<MapData> maps) {
  return test::config_error("no folder", [&] { static_cast<void>(joined(std::move(maps))); });
}

TEST(SeveralMaps, AreOneGridWithUnknownCellsBetween) {
  const GlobalMap map(joined({small_map({1, 2, 0}), small_map({-7, 5, 0})}));
  const OccupancyGrid& grid = map.grid();
  EXPECT_EQ(grid.map_from_grid, (Pose2{1, 2, 0}));
  EXPECT_EQ(grid.width, 3 + 80 + 3);  // 40 m in between
  EXPECT_EQ(grid.height, 2);
  EXPECT_EQ(grid.cell(2, 0), Cell::occupied);
  EXPECT_EQ(grid.cell(3, 0), Cell::unknown);
  EXPECT_EQ(grid.cell(82, 0), Cell::unknown);
  EXPECT_EQ(grid.cell(83, 0), Cell::free);
  EXPECT_EQ(grid.cell(85, 0), Cell::occupied);
  ASSERT_EQ(map.points().size(), 2U);
  EXPECT_EQ(map.points(), occupied_centres(grid));
  EXPECT_EQ(map.path().size(), 2U);
}

/// A map whose path tells its seed.
class Seeded final : public MapSource {
 public:
  struct Params {};
  Seeded(const Params& /*params*/, const SourceSetup& setup) : seed_(static_cast<double>(setup.seed)) {}
  [[nodiscard]] MapData load() override {
    MapData map = small_map({});
    map.path = {Pose2{seed_, 0.0, 0.0}};
    return map;
  }

 private:
  double seed_;
};
void describe(ParamVisitor& /*v*/, Seeded::Params& /*p*/) {}

TEST(SeveralMaps, MayHaveSidesInSinglePrecision) {
  MapData sent = small_map({});
  sent.grid.resolution = static_cast<double>(0.5F + 5e-8F);
  EXPECT_EQ(joined({small_map({}), sent}).parts.size(), 2U);
}

TEST(SeveralMaps, DrawRandomNumbersOfTheirOwn) {
  Registry<MapSource, SourceSetup> sources{"map_source"};
  sources.add<Seeded>("seeded", "Tells its seed.");
  SeveralMaps::Params params{.sources = &sources};
  for (const char* name : {"a", "b", "c"}) params.maps.push_back({&sources, name, sources.choose("seeded")});
  SourceSetup setup;
  setup.seed = 7;
  std::set<double> seeds;
  for (const Pose3& pose : SeveralMaps(params, setup).load().path) seeds.insert(pose.x);
  EXPECT_EQ(seeds.size(), 3U);
  EXPECT_TRUE(seeds.contains(7.0)) << "the first draws as it would alone";
}

TEST(SeveralMaps, TellEachPoseInTheFrameOfItsOwnMap) {
  const GlobalMap map(joined({small_map({1, 2, 0}), small_map({-7, 5, 0}), small_map({0, 0, 0})}));
  const MapPlace first = map.place_of(Pose2{1.5, 2.5, 0.3});
  EXPECT_EQ(first.map, "floor 0");
  EXPECT_EQ(first.map_from_robot, Pose3(Pose2{1.5, 2.5, 0.3}));
  // The second begins 41.5 m beyond the first's corner: at x = 42.5, y = 2 instead of -7, 5.
  const MapPlace second = map.place_of(Pose2{43.0, 2.5, 0.3});
  EXPECT_EQ(second.map, "floor 1");
  EXPECT_NEAR(second.map_from_robot.x, -6.5, 1e-12);
  EXPECT_NEAR(second.map_from_robot.y, 5.5, 1e-12);
  EXPECT_NEAR(second.map_from_robot.heading(), 0.3, 1e-12);
  // Half way between two maps.
  EXPECT_EQ(map.place_of(Pose2{22.4, 0, 0}).map, "floor 0");
  EXPECT_EQ(map.place_of(Pose2{22.6, 0, 0}).map, "floor 1");
  EXPECT_EQ(map.place_of(Pose2{-1e4, 0, 0}).map, "floor 0");
  EXPECT_EQ(map.place_of(Pose2{1e4, 0, 0}).map, "floor 2");
}

TEST(SeveralMaps, TurnsAMapWhoseCellsAreTurned) {
  constexpr double right_angle = std::numbers::pi / 2.0;
  const GlobalMap map(joined({small_map({1, 2, 0}), small_map({10, 20, right_angle})}));
  // Its columns go along y there, and along x here.
  EXPECT_EQ(map.grid().cell(85, 0), Cell::occupied);
  const Points centres = occupied_centres(map.grid());
  EXPECT_NEAR(map.points().x[1], centres.x[1], 1e-5);
  EXPECT_NEAR(map.points().y[1], centres.y[1], 1e-5);
  const MapPlace place = map.place_of(Pose2{centres.x[1], centres.y[1], 0.0});
  EXPECT_NEAR(place.map_from_robot.x, 10 - 0.25, 1e-5);
  EXPECT_NEAR(place.map_from_robot.y, 20 + 1.25, 1e-5);
  EXPECT_NEAR(place.map_from_robot.heading(), right_angle, 1e-12);
}

TEST(SeveralMaps, KeepsMapsFarFromTheirOriginExact) {
  MapData far = small_map({1, 2, 0});
  far.origin = {500'000.0, 4'000'000.0, 0.0};
  const GlobalMap map(joined({far, small_map({-7, 5, 0}), far}));
  EXPECT_EQ(map.origin(), far.origin);
  EXPECT_EQ(map.place_of(Pose2{500'001.5, 4'000'002.5, 0.3}).map, "floor 0");
  const MapPlace second = map.place_of(Pose2{500'043.0, 4'000'002.5, 0.3});
  EXPECT_EQ(second.map, "floor 1");
  EXPECT_NEAR(second.map_from_robot.x, -6.5, 1e-8);
  const MapPlace third = map.place_of(Pose2{500'084.5, 4'000'002.5, 0.3});
  EXPECT_EQ(third.map, "floor 2");
  EXPECT_NEAR(third.map_from_robot.x, 500'001.5, 1e-8);
  EXPECT_NEAR(third.map_from_robot.y, 4'000'002.5, 1e-8);
}

TEST(SeveralMaps, JoinsCloudsWithTheirFreeVoxels) {
  const auto cloud = [](const Pose2& corner) {
    MapData map;
    map.points.push_back({static_cast<float>(corner.x) + 0.1F, static_cast<float>(corner.y), 1.0F});
    map.normals.push_back({1.0F, 0.0F, 0.0F});
    map.free_voxels = FreeVoxels(corner, 0.5);
    map.free_voxels.add(2, -3, 9);
    return map;
  };
  const GlobalMap map(joined({cloud({1, 2, 0}), cloud({-7, 5, 0})}));
  ASSERT_EQ(map.points().size(), 2U);
  EXPECT_EQ(map.normals().size(), 2U);
  EXPECT_TRUE(map.free_voxels().contains({2.1F, 0.6F, 4.6F}));
  const float x = map.points().x[1] - 0.1F + 1.1F;  // From the second's corner.
  EXPECT_GT(x, 100.0F);
  EXPECT_TRUE(map.free_voxels().contains({x, 0.6F, 4.6F}));
  EXPECT_FALSE(map.free_voxels().contains({x + 0.5F, 0.6F, 4.6F}));
  EXPECT_EQ(map.place_of(Pose2{x, 0, 0}).map, "floor 1");
}

TEST(SeveralMaps, RefusesMapsThatDoNotFitTogether) {
  MapData coarse = small_map({0, 0, 0});
  coarse.grid.resolution = 0.25;
  EXPECT_EQ(refused({small_map({0, 0, 0}), coarse}),
            "error: 'floor 1' has cells of 0.25 m, and 'floor 0' of 0.5 m; make them anew with the "
            "same");
}

TEST(SeveralMaps, RefusesCloudsOfOtherDensitiesInEitherOrder) {
  MapData fine = small_map({0, 0, 0});
  fine.grid = {};
  fine.resolution = 0.05;
  MapData coarse = fine;
  coarse.resolution = 0.5;
  EXPECT_EQ(refused({fine, coarse}),
            "error: points of 'floor 1' lie 0.5 m apart, and those of 'floor 0' 0.05 m; make them anew with "
            "like distances");
  EXPECT_EQ(refused({coarse, fine}),
            "error: points of 'floor 1' lie 0.05 m apart, and those of 'floor 0' 0.5 m; make them anew with "
            "like distances");
  coarse.resolution = 0.06;
  EXPECT_EQ(joined({fine, coarse}).resolution, 0.06);
  EXPECT_EQ(joined({coarse, fine}).resolution, 0.06);
}

TEST(SeveralMaps, ComparesDensitiesOfAllClouds) {
  const auto clouds = [](const std::vector<double>& resolutions) {
    std::vector<MapData> maps;
    for (const double resolution : resolutions) {
      maps.push_back(small_map({0, 0, 0}));
      maps.back().grid = {};
      maps.back().resolution = resolution;
    }
    return maps;
  };
  EXPECT_EQ(refused(clouds({0.10, 0.14, 0.20})),
            "error: points of 'floor 2' lie 0.2 m apart, and those of 'floor 0' 0.1 m; make them anew with "
            "like distances");
  EXPECT_EQ(refused(clouds({0.14, 0.20, 0.10})),
            "error: points of 'floor 2' lie 0.1 m apart, and those of 'floor 1' 0.2 m; make them anew with "
            "like distances");
  EXPECT_EQ(joined(clouds({0.14, 0.0, 0.20})).resolution, 0.20) << "of one nothing is known";
}

TEST(SeveralMaps, RefusesCellsBesideACloud) {
  MapData cloud = small_map({0, 0, 0});
  cloud.grid = {};
  EXPECT_EQ(refused({small_map({0, 0, 0}), cloud}),
            "error: 'floor 1' has points alone, and 'floor 0' has cells; give maps of one kind");
}

}  // namespace
}  // namespace glocal::several::several_maps_test
