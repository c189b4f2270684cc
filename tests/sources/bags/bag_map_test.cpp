#include "sources/bags/bag_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "files.hpp"
#include "sources/bags/message_writer.hpp"

namespace glocal::test::bags::bag_map_test {
namespace {

using testing::HasSubstr;

class BagMaps : public testing::Test {
 protected:
  MapData load() {
    params_.path = file_path(folder_.write("map.mcap", recording_.bytes()));
    return glocal::bags::BagMap(params_, {}).load();
  }
  std::string fault() {
    return config_error(folder_.path(), [&] { load(); });
  }

  TemporaryFolder folder_;
  RobotRecording recording_;
  glocal::bags::BagMap::Params params_;
};

TEST_F(BagMaps, CellsAreFreeOccupiedOrUnknownByTheirShare) {
  recording_.grid("/map", 0, 0.5F, 6, {0, 19, 20, 65, 66, 100, -1, 101, -128, 127, 50, 10});
  const OccupancyGrid grid = load().grid;
  using enum Cell;
  EXPECT_THAT(grid.cells, testing::ElementsAre(free, free, unknown, unknown, occupied, occupied, unknown,
                                               unknown, unknown, unknown, unknown, free));
  EXPECT_EQ(grid.width, 6);
  EXPECT_EQ(grid.height, 2);
  EXPECT_EQ(grid.resolution, 0.5);
}

TEST_F(BagMaps, CellsLieWhereTheOriginSays) {
  recording_.grid("/map", 0, 1.0F, 2, {0, 100}, Pose2{10.0, 20.0, std::numbers::pi / 2.0});
  const MapData map = load();
  ASSERT_EQ(map.points.size(), 1U);
  // The second cell's centre is 1.5 m along the grid's x, which is the map's y.
  EXPECT_NEAR(map.points.x[0], 9.5, 1e-5);
  EXPECT_NEAR(map.points.y[0], 21.5, 1e-5);
}

TEST_F(BagMaps, FarAwayCellsAreHeldRelativeToAnOriginInWholeMetres) {
  recording_.grid("/map", 0, 1.0F, 2, {0, 100}, Pose2{500'000.25, 4'649'776.0, std::numbers::pi / 2.0});
  const MapData map = load();
  EXPECT_EQ(map.origin, Vector3(500'000, 4'649'776, 0));
  ASSERT_EQ(map.points.size(), 1U);
  EXPECT_NEAR(map.points.x[0], -0.25, 1e-6);
  EXPECT_NEAR(map.points.y[0], 1.5, 1e-6);
}

TEST_F(BagMaps, TheLastMessageCounts) {
  recording_.grid("/map", 0, 1.0F, 2, {100, 100});
  recording_.grid("/map", 5, 1.0F, 2, {0, 100});
  EXPECT_EQ(load().points.size(), 1U);
}

TEST_F(BagMaps, OneOfSeveralIsToBeNamed) {
  recording_.grid("/a", 0, 1.0F, 1, {100});
  recording_.grid("/b", 0, 1.0F, 2, {100, 100});
  EXPECT_THAT(fault(), HasSubstr("map.mcap: error: has several maps; set topic to one of /a, /b"));
  params_.topic = "/b";
  EXPECT_EQ(load().points.size(), 2U);
  params_.topic = "/c";
  EXPECT_THAT(fault(), HasSubstr("has no map on /c; set topic to one of /a, /b"));
}

TEST_F(BagMaps, WhatIsNoMapIsRefused) {
  recording_.scan("/scan", 0, {.ranges = {1.0F}});
  EXPECT_THAT(fault(), HasSubstr("has no map (nav_msgs/OccupancyGrid)"));
  recording_.grid("/map", 0, 1.0F, 2, {0, -1});
  EXPECT_THAT(fault(), HasSubstr("the map of /map has no occupied cell"));
  recording_.grid("/map", 1, 1.0F, 1, {100}, Pose3(exponential({0.5, 0.0, 0.0})));
  EXPECT_THAT(fault(), HasSubstr("the map of /map is tilted"));
}

}  // namespace
}  // namespace glocal::test::bags::bag_map_test
