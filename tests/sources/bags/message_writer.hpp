// Messages, and recordings of them, written field by field.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "glocal/pose3.hpp"
#include "sources/bags/recordings.hpp"

namespace glocal::test::bags {

/// Writes fields as ROS 1 or CDR has them.
class Writer {
 public:
  explicit Writer(const std::string& encoding, std::endian order = std::endian::little)
      : is_ros1_(encoding == "ros1"), order_(order) {}

  template <class T>
  Writer& number(T value) {
    if (!is_ros1_) bytes_.resize((bytes_.size() + sizeof(T) - 1) / sizeof(T) * sizeof(T), '\0');
    std::string own = le(value);
    if (order_ == std::endian::big) std::reverse(own.begin(), own.end());
    bytes_ += own;
    return *this;
  }
  Writer& text(const std::string& text) {
    number(static_cast<std::uint32_t>(text.size() + (is_ros1_ ? 0 : 1)));
    bytes_ += is_ros1_ ? text : text + '\0';
    return *this;
  }
  Writer& raw(const std::string& bytes) {
    number(static_cast<std::uint32_t>(bytes.size()));
    bytes_ += bytes;
    return *this;
  }
  Writer& header(const std::string& frame, std::int64_t stamp_ns = 5'000'000'006) {
    if (is_ros1_) number<std::uint32_t>(77);
    constexpr std::int64_t second = 1'000'000'000;
    return number(static_cast<std::uint32_t>(stamp_ns / second))
        .number(static_cast<std::uint32_t>(stamp_ns % second))
        .text(frame);
  }
  Writer& pose(const Pose3& p = {{1.0, 2.0, 3.0}, {0.8, 0.0, 0.0, 0.6}}) {
    const Quaternion& q = p.rotation;
    for (const double v : {p.x, p.y, p.z, q.x(), q.y(), q.z(), q.w()}) number(v);
    return *this;
  }
  [[nodiscard]] std::string bytes() const {
    if (is_ros1_) return bytes_;
    return std::string(order_ == std::endian::big ? "\0\0\0\0" : "\0\1\0\0", 4) + bytes_;
  }

 private:
  bool is_ros1_;
  std::endian order_;
  std::string bytes_;
};

/// Fields of a sensor_msgs/LaserScan.
struct ScanFields {
  std::string frame = "laser";
  float angle_min = 0.0F, angle_increment = 0.0F, time_increment = 0.0F;
  float range_min = 0.0F, range_max = 30.0F;
  std::vector<float> ranges;
};

/// A recording of messages as CDR: an MCAP file without chunks.
class RobotRecording {
 public:
  void scan(const std::string& topic, std::int64_t stamp_ns, const ScanFields& fields,
            std::optional<std::int64_t> received_ns = std::nullopt) {
    Writer w = cdr();
    w.header(fields.frame, stamp_ns);
    const auto last = static_cast<float>(fields.ranges.size()) - 1.0F;
    for (const float v :
         {fields.angle_min, fields.angle_min + last * fields.angle_increment, fields.angle_increment,
          fields.time_increment, 0.1F, fields.range_min, fields.range_max})
      w.number(v);
    w.number(static_cast<std::uint32_t>(fields.ranges.size()));
    for (const float range : fields.ranges) w.number(range);
    w.number<std::uint32_t>(0);
    add(topic, "sensor_msgs/msg/LaserScan", received_ns.value_or(stamp_ns), w);
  }
  /// A cloud of x, y, z.
  void cloud(const std::string& topic, std::int64_t stamp_ns, const std::string& frame,
             const std::vector<Vector3>& points) {
    constexpr std::uint8_t float32 = 7;
    Writer w = cdr();
    w.header(frame, stamp_ns).number<std::uint32_t>(1).number(static_cast<std::uint32_t>(points.size()));
    w.number<std::uint32_t>(3);
    std::uint32_t offset = 0;
    for (const char* name : {"x", "y", "z"}) {
      w.text(name).number(offset).number(float32).number<std::uint32_t>(1);
      offset += 4;
    }
    const auto row = static_cast<std::uint32_t>(points.size() * offset);
    w.number<std::uint8_t>(0).number(offset).number(row);
    std::string data;
    for (const Vector3& p : points) {
      for (const double v : {p.x(), p.y(), p.z()}) data += le(static_cast<float>(v));
    }
    add(topic, "sensor_msgs/msg/PointCloud2", stamp_ns, w.raw(data).number<std::uint8_t>(1));
  }
  void transform(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                 const Pose3& pose, const std::string& topic = "/tf") {
    add(topic, "tf2_msgs/msg/TFMessage", stamp_ns,
        cdr().number<std::uint32_t>(1).header(parent, stamp_ns).text(child).pose(pose));
  }
  void odometry(const std::string& topic, std::int64_t stamp_ns, const std::string& frame,
                const std::string& child, const Pose3& pose) {
    add(topic, "nav_msgs/msg/Odometry", stamp_ns, cdr().header(frame, stamp_ns).text(child).pose(pose));
  }
  void pose(const std::string& topic, std::int64_t stamp_ns, const std::string& frame, const Pose3& pose) {
    add(topic, "geometry_msgs/msg/PoseStamped", stamp_ns, cdr().header(frame, stamp_ns).pose(pose));
  }
  void grid(const std::string& topic, std::int64_t stamp_ns, float resolution, std::uint32_t width,
            const std::vector<std::int8_t>& cells, const Pose3& origin = {}) {
    Writer w = cdr();
    w.header("map", stamp_ns).number<std::uint32_t>(0).number<std::uint32_t>(0).number(resolution);
    w.number(width).number(static_cast<std::uint32_t>(cells.size()) / width).pose(origin);
    w.raw({cells.begin(), cells.end()});
    add(topic, "nav_msgs/msg/OccupancyGrid", stamp_ns, w);
  }
  void add(const std::string& topic, const std::string& type, std::int64_t stamp_ns, const Writer& message) {
    auto known = std::find(topics_.begin(), topics_.end(), topic);
    if (known == topics_.end()) {
      topics_.push_back(topic);
      known = topics_.end() - 1;
      records_ += mcap_channel(static_cast<std::uint16_t>(topics_.size()), topic, type);
    }
    const auto id = static_cast<std::uint16_t>(known - topics_.begin() + 1);
    records_ += mcap_message(id, static_cast<std::uint64_t>(stamp_ns), message.bytes());
  }
  [[nodiscard]] std::string bytes() const { return mcap_file(records_); }
  [[nodiscard]] static Writer cdr() { return Writer("cdr"); }

 private:
  std::vector<std::string> topics_;
  std::string records_;
};

}  // namespace glocal::test::bags
