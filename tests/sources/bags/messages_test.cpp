#include "sources/bags/messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "files.hpp"
#include "sources/bags/message_reader.hpp"
#include "sources/bags/message_writer.hpp"

namespace glocal::test::bags::messages_test {
namespace {

using namespace glocal::bags;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

struct Serialization {
  std::string encoding;
  std::endian order = std::endian::little;
};

class Messages : public testing::TestWithParam<Serialization> {
 protected:
  [[nodiscard]] static Writer writer() { return Writer(GetParam().encoding, GetParam().order); }
  RecordedMessage message(const Writer& fields, const std::string& type) {
    bytes_ = fields.bytes();
    connection_ = {"/topic", type, GetParam().encoding, ""};
    return {&connection_, 0, bytes_, {"file", 100}};
  }
  /// Each message that ends early is refused.
  template <class Read>
  void expect_cuts_are_refused(RecordedMessage message, Read read, std::size_t least) {
    const std::string_view whole = message.bytes;
    for (std::size_t n = 0; n < least; ++n) {
      message.bytes = whole.substr(0, n);
      EXPECT_THROW(static_cast<void>(read(message)), ConfigError) << n;
    }
  }

  std::string bytes_;
  Connection connection_;
};

INSTANTIATE_TEST_SUITE_P(All, Messages,
                         testing::Values(Serialization{"ros1"}, Serialization{"cdr"},
                                         Serialization{"cdr", std::endian::big}),
                         [](const auto& s) {
                           return s.param.encoding + (s.param.order == std::endian::big ? "_big" : "");
                         });

TEST_P(Messages, OfScansHaveTheirRanges) {
  Writer fields = writer();
  fields.header("/laser");
  for (const float v : {-1.0F, 1.0F, 1.0F, 0.0F, 0.1F, 0.2F, 30.0F}) fields.number(v);
  fields.number<std::uint32_t>(3);
  for (const float v : {1.5F, 2.5F, 3.5F}) fields.number(v);
  const RecordedMessage m = message(fields, "sensor_msgs/LaserScan");
  const LaserScan scan = read_laser_scan(m);
  EXPECT_EQ(scan.header.stamp_ns, 5'000'000'006);
  EXPECT_EQ(scan.header.frame, "laser");
  EXPECT_EQ(scan.angle_min, -1.0F);
  EXPECT_EQ(scan.range_max, 30.0F);
  EXPECT_THAT(scan.ranges, ElementsAre(1.5F, 2.5F, 3.5F));
  expect_cuts_are_refused(m, read_laser_scan, m.bytes.size());
}

TEST_P(Messages, OfOdometryAndTransformsHavePoses) {
  const Pose3 pose({1.0, 2.0, 3.0}, {0.8, 0.0, 0.0, 0.6});
  const RecordedMessage m = message(writer().header("odom").text("base").pose(), "nav_msgs/Odometry");
  const Odometry odometry = read_odometry(m);
  EXPECT_EQ(odometry.child_frame, "base");
  EXPECT_EQ(odometry.frame_from_child, pose);
  expect_cuts_are_refused(m, read_odometry, m.bytes.size());

  const RecordedMessage tf = message(writer()
                                         .number<std::uint32_t>(2)
                                         .header("map")
                                         .text("odom")
                                         .pose()
                                         .header("odom")
                                         .text("base_link")
                                         .pose(),
                                     "tf2_msgs/TFMessage");
  const auto transforms = read_transforms(tf);
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms[1].header.frame, "odom");
  EXPECT_EQ(transforms[1].child_frame, "base_link");
  EXPECT_EQ(transforms[1].parent_from_child, pose);
  expect_cuts_are_refused(tf, read_transforms, tf.bytes.size());
}

TEST_P(Messages, OfPosesMayHaveACovariance) {
  Writer fields = writer();
  fields.header("map").pose();
  EXPECT_TRUE(read_pose(message(fields, "geometry_msgs/PoseStamped")).covariance.empty());
  for (int i = 0; i < 36; ++i) fields.number<double>(i);
  const StampedFramePose pose = read_pose(message(fields, "geometry_msgs/PoseWithCovarianceStamped"));
  ASSERT_EQ(pose.covariance.size(), 36U);
  EXPECT_EQ(pose.covariance[35], 35.0);
}

TEST_P(Messages, OfGridsHaveTheirCells) {
  const RecordedMessage m = message(writer()
                                        .header("map")
                                        .number<std::uint32_t>(1)
                                        .number<std::uint32_t>(2)
                                        .number(0.5F)
                                        .number<std::uint32_t>(3)
                                        .number<std::uint32_t>(1)
                                        .pose()
                                        .raw(std::string("\xff\x00\x64", 3)),
                                    "nav_msgs/OccupancyGrid");
  const GridMessage grid = read_occupancy_grid(m);
  EXPECT_EQ(grid.resolution, 0.5);
  EXPECT_EQ(grid.width, 3U);
  EXPECT_THAT(grid.cells, ElementsAre(-1, 0, 100));
  expect_cuts_are_refused(m, read_occupancy_grid, m.bytes.size());
}

/// A cloud of two rows of one point each: padding, x as float64, y and z as float32, t in ns.
Writer cloud(Writer fields, bool is_big) {
  fields.header("lidar").number<std::uint32_t>(2).number<std::uint32_t>(1).number<std::uint32_t>(4);
  const auto field = [&](const std::string& name, std::uint32_t offset, std::uint8_t type) {
    fields.text(name).number(offset).number(type).number<std::uint32_t>(1);
  };
  field("x", 1, 8);
  field("y", 9, 7);
  field("z", 13, 7);
  field("t", 17, 6);
  fields.number<std::uint8_t>(is_big ? 1 : 0).number<std::uint32_t>(21).number<std::uint32_t>(25);
  std::string data;
  const auto add = [&](auto value) {
    std::string own = le(value);
    if (is_big) std::reverse(own.begin(), own.end());
    data += own;
  };
  for (const double x : {1.0, static_cast<double>(NAN)}) {
    data += '?';
    add(x);
    add(2.0F);
    add(3.0F);
    add(std::uint32_t{500'000'000});
    data += "row!";
  }
  return fields.raw(data).number<std::uint8_t>(0);
}

TEST_P(Messages, OfCloudsHaveTheirFinitePoints) {
  for (const bool is_big : {false, true}) {
    const RecordedMessage m = message(cloud(writer(), is_big), "sensor_msgs/PointCloud2");
    const PointCloud points = read_point_cloud(m);
    ASSERT_EQ(points.points.size(), 1U);
    EXPECT_EQ(points.points.x[0], 1.0F);
    EXPECT_EQ(points.points.y[0], 2.0F);
    EXPECT_EQ(points.points.z[0], 3.0F);
    EXPECT_THAT(points.times, ElementsAre(0.5));
    EXPECT_EQ(points.left_out, 1U);
    expect_cuts_are_refused(m, read_point_cloud, m.bytes.size() - 1);
  }
}

/// A cloud with a point at (1, 2, 3) for each stamp, which are float64.
Writer stamped_cloud(Writer fields, const std::vector<double>& stamps) {
  constexpr std::uint8_t float32 = 7, float64 = 8;
  constexpr std::uint32_t point_step = 20;
  const auto n = static_cast<std::uint32_t>(stamps.size());
  fields.header("lidar").number<std::uint32_t>(1).number(n).number<std::uint32_t>(4);
  const auto field = [&](const std::string& name, std::uint32_t offset, std::uint8_t type) {
    fields.text(name).number(offset).number(type).number<std::uint32_t>(1);
  };
  field("x", 0, float32);
  field("y", 4, float32);
  field("z", 8, float32);
  field("timestamp", 12, float64);
  fields.number<std::uint8_t>(0).number(point_step).number(n * point_step);
  std::string data;
  for (const double stamp : stamps) data += le(1.0F) + le(2.0F) + le(3.0F) + le(stamp);
  return fields.raw(data).number<std::uint8_t>(1);
}

TEST_P(Messages, OfCloudsHaveTheirTimesInSecondsWhateverTheirUnit) {
  const auto times = [&](const std::vector<double>& stamps) {
    return read_point_cloud(message(stamped_cloud(writer(), stamps), "sensor_msgs/PointCloud2")).times;
  };
  EXPECT_THAT(times({0.0, 0.1}), ElementsAre(0.0, 0.1));
  EXPECT_THAT(times({1.7e9, 1.7e9 + 0.125}), ElementsAre(1.7e9, 1.7e9 + 0.125));
  EXPECT_THAT(times({1.7e18, 1.7e18 + 1.25e8}), ElementsAre(1.7e9, DoubleNear(1.7e9 + 0.125, 1e-6)));
  // Of a lidar whose clock counts from its start.
  EXPECT_THAT(times({7.0e10, 7.01e10}), ElementsAre(DoubleNear(70.0, 1e-9), DoubleNear(70.1, 1e-9)));
  EXPECT_THAT(config_error("", [&] { times({0.0, 1.7e9}); }), HasSubstr("at most 1000 s apart"));
  EXPECT_THAT(config_error("", [&] { times({0.0, 1.7e18}); }), HasSubstr("at most 1000 s apart"));
}

TEST_P(Messages, SayWhatIsWrongWithThem) {
  Writer fields = writer();
  fields.header("odom").text("base");
  for (const double v : {1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0}) fields.number(v);
  const RecordedMessage m = message(fields, "nav_msgs/Odometry");
  EXPECT_THAT(config_error("here", [&] { static_cast<void>(read_odometry(m)); }),
              HasSubstr("nav_msgs/Odometry of topic /topic: the quaternion has a length of 0 instead of 1"));
}

TEST(Cdr, AlignsNumbersToTheirSizeFromTheEndOfItsHeader) {
  const Connection connection{"/t", "x/X", "cdr", ""};
  const std::string little(
      "\0\1\0\0"
      "\7\0\2\1\0\0\0\0\3\0\0\0\0\0\0\0",
      20);
  MessageReader reader({&connection, 0, little, {"file"}});
  EXPECT_EQ(reader.number<std::uint8_t>(), 7);
  EXPECT_EQ(reader.number<std::uint16_t>(), 0x0102);
  EXPECT_EQ(reader.number<std::uint64_t>(), 3U);
  const std::string big(
      "\0\0\0\0"
      "\7\0\2\1\0\0\0\0\0\0\0\0\0\0\0\3",
      20);
  MessageReader other({&connection, 0, big, {"file"}});
  EXPECT_EQ(other.number<std::uint8_t>(), 7);
  EXPECT_EQ(other.number<std::uint16_t>(), 0x0201);
  EXPECT_EQ(other.number<std::uint64_t>(), 3U);
}

TEST(Cdr, OfOtherVersionsIsRefused) {
  const Connection connection{"/t", "x/X", "cdr", ""};
  EXPECT_THAT(
      config_error("",
                   [&] {
                     MessageReader reader({&connection, 0, std::string_view("\0\7\0\0", 4), {"file"}});
                   }),
      HasSubstr("the message's CDR is of representation 0007"));
  const Connection json{"/t", "x/X", "json", ""};
  EXPECT_FALSE(is_readable(json));
  EXPECT_THAT(config_error("",
                           [&] {
                             MessageReader reader({&json, 0, "{}", {"file"}});
                           }),
              HasSubstr("messages encoded as 'json' cannot be read"));
}

}  // namespace
}  // namespace glocal::test::bags::messages_test
