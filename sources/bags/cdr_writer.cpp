#include "sources/bags/cdr_writer.hpp"

#include <array>
#include <bit>
#include <cstring>

#include "sources/bags/message_definitions.hpp"
#include "sources/bags/message_reader.hpp"

namespace glocal::bags {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are written as memory has them");

constexpr std::size_t encapsulation = 4;  // bytes

class Recoder {
 public:
  explicit Recoder(const RecordedMessage& message) : from_(message) {}

  std::string recoded(std::string_view type) {
    copy_message(type);
    return to_.message();
  }

 private:
  void copy_message(std::string_view type) {
    if (type == "std_msgs/Header") static_cast<void>(from_.number<std::uint32_t>());  // Sequence number.
    for (const MessageField& field : fields_of(type)) copy_field(field);
  }

  void copy_field(const MessageField& field) {
    if (field.is_sequence && size_of_number(field.type) == 1) {
      to_.bytes(from_.bytes());
      return;
    }
    std::size_t n = field.count;
    if (field.is_sequence) {
      n = from_.count(1);
      to_.count(n);
    }
    for (; n > 0; --n) copy_element(field.type);
  }

  void copy_element(std::string_view type) {
    if (type == "string") {
      to_.text(from_.text());
      return;
    }
    switch (size_of_number(type)) {
      case 1:
        to_.number(from_.number<std::uint8_t>());
        break;
      case sizeof(std::uint32_t):
        to_.number(from_.number<std::uint32_t>());
        break;
      case sizeof(std::uint64_t):
        to_.number(from_.number<std::uint64_t>());
        break;
      default:
        copy_message(type);
    }
  }

  /// Bytes; 0 for what is no number. There are none of 16 bits.
  static std::size_t size_of_number(std::string_view type) {
    if (type == "bool" || type == "byte" || type == "int8" || type == "uint8") return 1;
    if (type == "int32" || type == "uint32" || type == "float32") return sizeof(std::uint32_t);
    return type == "float64" ? sizeof(std::uint64_t) : 0;
  }

  MessageReader from_;
  CdrWriter to_;
};

}  // namespace

CdrWriter& CdrWriter::text(std::string_view text) {
  constexpr char end = '\0';
  count(text.size() + 1);
  append(text.data(), text.size());
  append(&end, 1);
  return *this;
}

CdrWriter& CdrWriter::bytes(std::string_view bytes) {
  count(bytes.size());
  append(bytes.data(), bytes.size());
  return *this;
}

CdrWriter& CdrWriter::header(const Header& header) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  return number(static_cast<std::int32_t>(header.stamp_ns / ns_per_s))
      .number(static_cast<std::uint32_t>(header.stamp_ns % ns_per_s))
      .text(header.frame);
}

CdrWriter& CdrWriter::rigid_motion(const Pose3& motion) {
  const Quaternion& q = motion.rotation;
  for (const double value : {motion.x, motion.y, motion.z, q.x(), q.y(), q.z(), q.w()}) number(value);
  return *this;
}

void CdrWriter::align(std::size_t size) {
  const std::size_t beyond = (bytes_.size() - encapsulation) % size;
  if (beyond != 0) bytes_.append(size - beyond, '\0');
}

void CdrWriter::append(const void* bytes, std::size_t n) {
  bytes_.append(static_cast<const char*>(bytes), n);
}

std::string serialized(const LaserScan& scan) {
  CdrWriter writer;
  writer.header(scan.header);
  for (const float value : {scan.angle_min, scan.angle_max, scan.angle_increment, scan.time_increment,
                            scan.scan_time, scan.range_min, scan.range_max})
    writer.number(value);
  writer.count(scan.ranges.size());
  for (const float range : scan.ranges) writer.number(range);
  return writer.count(0).message();  // No intensities.
}

std::string serialized(const PointCloud& cloud) {
  constexpr std::uint8_t float32 = 7;
  constexpr std::array<const char*, 4> names = {"x", "y", "z", "time"};
  const std::size_t fields = cloud.times.empty() ? 3 : 4;
  const auto n = static_cast<std::uint32_t>(cloud.points.size());
  const auto point_step = static_cast<std::uint32_t>(fields * sizeof(float));
  CdrWriter writer;
  writer.header(cloud.header).number<std::uint32_t>(1).number(n).count(fields);
  for (std::size_t i = 0; i < fields; ++i)
    writer.text(names.at(i)).count(i * sizeof(float)).number(float32).count(1);
  writer.number<std::uint8_t>(0).number(point_step).number(n * point_step);
  std::string data(std::size_t{n} * point_step, '\0');
  for (std::size_t i = 0; i < n; ++i) {
    const std::array<float, 4> values = {cloud.points.x[i], cloud.points.y[i], cloud.points.z[i],
                                         cloud.times.empty() ? 0.0F : static_cast<float>(cloud.times[i])};
    std::memcpy(data.data() + i * point_step, values.data(), point_step);
  }
  return writer.bytes(data).number<std::uint8_t>(1).message();
}

std::string serialized(const std::vector<FrameTransform>& transforms) {
  CdrWriter writer;
  writer.count(transforms.size());
  for (const FrameTransform& transform : transforms)
    writer.header(transform.header).text(transform.child_frame).rigid_motion(transform.parent_from_child);
  return writer.message();
}

std::string serialized(const GridMessage& grid) {
  CdrWriter writer;
  writer.header(grid.header).number<std::int32_t>(0).number<std::uint32_t>(0);  // Time of loading.
  writer.number(static_cast<float>(grid.resolution)).number(grid.width).number(grid.height);
  return writer.rigid_motion(grid.frame_from_grid)
      .bytes(std::string(grid.cells.begin(), grid.cells.end()))
      .message();
}

std::string serialized(const StampedFramePose& pose) {
  return CdrWriter().header(pose.header).rigid_motion(pose.pose).message();
}

std::string type_in_ros2(const std::string& type) {
  return type == "tf/tfMessage" ? "tf2_msgs/TFMessage" : type;
}

std::string as_cdr(const RecordedMessage& ros1_message) {
  return Recoder(ros1_message).recoded(type_in_ros2(ros1_message.connection->type));
}

}  // namespace glocal::bags
