#include "sources/live/live_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/live/fake_link.hpp"

namespace glocal::test::live::live_map_test {
namespace {

using glocal::live::live_map;
using glocal::live::map_message;
using testing::HasSubstr;

const LiveTopic topic{"/map", "nav_msgs/OccupancyGrid"};

std::string grid(const std::vector<std::int8_t>& cells, const Pose2& map_from_grid = {1.0, 2.0, 0.0}) {
  bags::Writer w("cdr");
  w.header("map").number<std::uint32_t>(0).number<std::uint32_t>(0).number(0.5F);
  w.number(static_cast<std::uint32_t>(cells.size())).number<std::uint32_t>(1).pose(map_from_grid);
  return w.raw({cells.begin(), cells.end()}).bytes();
}

bool never() {
  return false;
}

TEST(LiveMap, IsWhatTheMapServerSends) {
  FakeLink link;
  link.put(topic, 0, grid({-1, 0, 100}));
  const MapData map = live_map(link, "", never);
  ASSERT_EQ(map.points.size(), 1U);
  EXPECT_NEAR(map.points.x[0] + map.origin.x(), 2.25, 1e-6);
  EXPECT_NEAR(map.points.y[0] + map.origin.y(), 2.25, 1e-6);
  EXPECT_EQ(map.grid.cells, (PackedCells{Cell::unknown, Cell::free, Cell::occupied}));
}

TEST(LiveMap, OfSeveralOneIsToBeNamed) {
  FakeLink link;
  link.put(topic, 0, grid({100}));
  link.put({"/other", topic.type}, 0, grid({100, 100}));
  EXPECT_THAT(config_error("no folder", [&] { static_cast<void>(live_map(link, "", never)); }),
              HasSubstr("set topic to one of /map, /other"));
  EXPECT_EQ(live_map(link, "/other", never).points.size(), 2U);
}

TEST(LiveMap, TellsWhatThereIsInsteadOfAMap) {
  FakeLink link;
  link.announce({"/scan", "sensor_msgs/LaserScan"});
  link.end();
  EXPECT_THAT(config_error("no folder", [&] { static_cast<void>(live_map(link, "", never)); }),
              HasSubstr("no map (nav_msgs/OccupancyGrid) came at all within 10 s; there are /scan"));
}

TEST(LiveMap, AMapWithoutWallsIsNone) {
  FakeLink link;
  link.put(topic, 0, grid({0, -1}));
  EXPECT_THAT(config_error("no folder", [&] { static_cast<void>(live_map(link, "/map", never)); }),
              HasSubstr("the map of /map has no occupied cell"));
}

TEST(LiveMap, OfAFileIsAMessageAsAMapServerSendsIt) {
  MapData map;
  map.grid = {.map_from_grid = {1.0, 2.0, 0.0},
              .resolution = 0.5,
              .width = 3,
              .height = 1,
              .cells = {Cell::unknown, Cell::free, Cell::occupied}};
  map.origin = {1000.0, -3000.0, 0.0};
  const LiveMessage message = map_message(map, "/map", {5'000'000'006, "map"});
  EXPECT_EQ(message.topic, topic);
  EXPECT_EQ(message.stamp_ns, 5'000'000'006);
  EXPECT_EQ(message.bytes, grid({-1, 0, 100}, {1001.0, -2998.0, 0.0}));
}

TEST(LiveMap, InSpaceIsACloud) {
  MapData map;
  map.points.push_back({1.0F, 2.0F, 3.0F});
  map.origin = {1000.0, 0.0, 0.0};
  const LiveMessage message = map_message(map, "/map", {8, "map"});
  EXPECT_EQ(message.topic, (LiveTopic{"/map", "sensor_msgs/PointCloud2"}));
  const glocal::bags::Connection connection{"/map", message.topic.type, "cdr", ""};
  const auto cloud = glocal::bags::read_point_cloud({&connection, 8, message.bytes, {.file = "/map"}});
  EXPECT_EQ(cloud.header.frame, "map");
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0], (Point{1001.0F, 2.0F, 3.0F}));
}

}  // namespace
}  // namespace glocal::test::live::live_map_test
