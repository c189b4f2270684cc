#include "sources/bags/cdr_writer.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "glocal/error.hpp"
#include "sources/bags/message_writer.hpp"

namespace glocal::test::bags::cdr_writer_test {
namespace {

using testing::ElementsAre;
namespace bags = glocal::bags;

bags::RecordedMessage message(const bags::Connection& connection, const std::string& bytes) {
  return {&connection, 0, bytes, {"file", 0}};
}

TEST(CdrWriter, WritesScansFieldByField) {
  bags::LaserScan scan;
  scan.header = {7'000'000'009, "front"};
  scan.angle_min = -1.0F;
  scan.angle_max = 1.0F;
  scan.angle_increment = 2.0F;
  scan.range_max = 30.0F;
  scan.ranges = {1.5F, std::numeric_limits<float>::infinity()};
  Writer expected("cdr");
  expected.header("front", 7'000'000'009);
  for (const float v : {-1.0F, 1.0F, 2.0F, 0.0F, 0.0F, 0.0F, 30.0F}) expected.number(v);
  expected.number<std::uint32_t>(2).number(1.5F).number(std::numeric_limits<float>::infinity());
  expected.number<std::uint32_t>(0);
  EXPECT_EQ(bags::serialized(scan), expected.bytes());
}

TEST(CdrWriter, WritesTransformsAndPoses) {
  const Pose3 pose({1.0, 2.0, 3.0}, {0.8, 0.0, 0.0, 0.6});
  EXPECT_EQ(bags::serialized(std::vector<bags::FrameTransform>{{{8, "odom"}, "base", pose},
                                                               {{9, "base"}, "laser_1", pose}}),
            Writer("cdr")
                .number<std::uint32_t>(2)
                .header("odom", 8)
                .text("base")
                .pose(pose)
                .header("base", 9)
                .text("laser_1")
                .pose(pose)
                .bytes());
  EXPECT_EQ(bags::serialized(bags::StampedFramePose{{8, "map"}, pose, {}}),
            Writer("cdr").header("map", 8).pose(pose).bytes());
}

TEST(CdrWriter, CloudsReadBackAsTheyWere) {
  bags::PointCloud cloud;
  cloud.header = {5'000'000'001, "lidar"};
  cloud.points.push_back({1.0F, -2.0F, 0.1F});
  cloud.points.push_back({4.0F, 5.0F, 6.0F});
  const bags::Connection connection{"/cloud", "sensor_msgs/PointCloud2", "cdr", ""};
  const std::string bytes = bags::serialized(cloud);
  const bags::PointCloud read = bags::read_point_cloud(message(connection, bytes));
  EXPECT_EQ(read.header.stamp_ns, 5'000'000'001);
  EXPECT_EQ(read.header.frame, "lidar");
  EXPECT_THAT(read.points.x, ElementsAre(1.0F, 4.0F));
  EXPECT_THAT(read.points.y, ElementsAre(-2.0F, 5.0F));
  EXPECT_THAT(read.points.z, ElementsAre(0.1F, 6.0F));
  EXPECT_TRUE(read.times.empty());
}

/// A message of each type, as ROS 1 or ROS 2 has it.
std::vector<std::pair<std::string, Writer>> messages(const std::string& encoding) {
  const auto numbers = [](Writer& writer, int n) -> Writer& {
    for (int i = 0; i < n; ++i) writer.number<double>(i + 0.5);
    return writer;
  };
  std::vector<std::pair<std::string, Writer>> all;
  Writer scan(encoding);
  scan.header("laser");
  for (int i = 0; i < 7; ++i) scan.number(0.5F * static_cast<float>(i));
  scan.number<std::uint32_t>(1).number(2.5F).number<std::uint32_t>(2).number(7.0F).number(8.0F);
  all.emplace_back("sensor_msgs/LaserScan", scan);
  Writer odometry(encoding);
  odometry.header("odom").text("base").pose();
  all.emplace_back("nav_msgs/Odometry", numbers(odometry, 36 + 6 + 36));
  Writer pose(encoding);
  pose.header("map").pose();
  all.emplace_back("geometry_msgs/PoseStamped", pose);
  all.emplace_back("geometry_msgs/PoseWithCovarianceStamped", numbers(pose, 36));
  Writer transforms(encoding);
  transforms.number<std::uint32_t>(2).header("odom").text("a").pose().header("map").text("odom").pose();
  all.emplace_back("tf2_msgs/TFMessage", transforms);
  Writer grid(encoding);
  grid.header("map").number<std::uint32_t>(1).number<std::uint32_t>(2).number(0.5F).number<std::uint32_t>(3);
  grid.number<std::uint32_t>(1).pose().raw(std::string("\xff\x00\x64", 3));
  all.emplace_back("nav_msgs/OccupancyGrid", grid);
  Writer cloud(encoding);
  cloud.header("lidar").number<std::uint32_t>(1).number<std::uint32_t>(1).number<std::uint32_t>(2);
  cloud.text("x").number<std::uint32_t>(0).number<std::uint8_t>(7).number<std::uint32_t>(1);
  cloud.text("ring").number<std::uint32_t>(4).number<std::uint8_t>(2).number<std::uint32_t>(1);
  cloud.number<std::uint8_t>(0).number<std::uint32_t>(5).number<std::uint32_t>(5).raw("12345");
  all.emplace_back("sensor_msgs/PointCloud2", cloud.number<std::uint8_t>(1));
  return all;
}

TEST(CdrWriter, MessagesOfRos1KeepAllTheirFields) {
  const auto ros1 = messages("ros1"), ros2 = messages("cdr");
  for (std::size_t i = 0; i < ros1.size(); ++i) {
    const auto& [type, fields] = ros1[i];
    const bags::Connection connection{"/topic", type, "ros1", ""};
    const std::string bytes = fields.bytes();
    EXPECT_EQ(bags::as_cdr(message(connection, bytes)), ros2[i].second.bytes()) << type;
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      const std::string cut = bytes.substr(0, n);
      EXPECT_THROW(static_cast<void>(bags::as_cdr(message(connection, cut))), ConfigError) << type << n;
    }
  }
}

}  // namespace
}  // namespace glocal::test::bags::cdr_writer_test
