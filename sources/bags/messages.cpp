#include "sources/bags/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/words.hpp"
#include "sources/bags/message_reader.hpp"
#include "sources/clouds/scalar.hpp"
#include "sources/text_lines.hpp"

namespace glocal::bags {
namespace {

using clouds::Scalar;

std::string frame_name(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return std::string(name);
}

Header read_header(MessageReader& reader) {
  if (reader.is_ros1()) static_cast<void>(reader.number<std::uint32_t>());  // Sequence number.
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  // ROS 1 has them unsigned, ROS 2 signed.
  const std::int64_t seconds = reader.is_ros1() ? std::int64_t{reader.number<std::uint32_t>()}
                                                : std::int64_t{reader.number<std::int32_t>()};
  const std::int64_t ns = reader.number<std::uint32_t>();
  return {seconds * ns_per_s + ns, frame_name(reader.text())};
}

/// geometry_msgs/Pose, Transform
Pose3 read_rigid_motion(MessageReader& reader) {
  std::array<double, 7> v{};
  for (double& value : v) value = reader.number<double>();
  const auto is_place = [](double value) { return std::abs(value) <= farthest_m; };
  if (!std::all_of(v.begin(), v.begin() + 3, is_place))
    reader.refuse(
        fmt::format("a coordinate is not finite or beyond {:g} m; is it of this type?", farthest_m));
  const double length = std::hypot(std::hypot(v[3], v[4]), std::hypot(v[5], v[6]));
  constexpr double tolerance = 1e-2;
  if (!(std::abs(length - 1.0) <= tolerance))
    reader.refuse(
        fmt::format("the quaternion has a length of {:.4g} instead of 1; the node that sent it must "
                    "normalise it",
                    length));
  return {{v[0], v[1], v[2]}, {v[6] / length, v[3] / length, v[4] / length, v[5] / length}};
}

constexpr std::size_t covariance_values = 36;

/// sensor_msgs/PointField
struct CloudField {
  std::size_t offset = 0;
  Scalar type = Scalar::float32;
};

/// x, y, z and perhaps the time.
using CloudFields = std::array<std::optional<CloudField>, 4>;

std::optional<std::size_t> use_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 7> names = {
      {{"x", 0}, {"y", 1}, {"z", 2}, {"t", 3}, {"time", 3}, {"timestamp", 3}, {"offset_time", 3}}};
  for (const auto& [known, use] : names) {
    if (name == known) return use;
  }
  return std::nullopt;
}

CloudFields read_cloud_fields(MessageReader& reader) {
  constexpr std::size_t types = 8, least_field = 13;
  CloudFields fields;
  for (std::size_t n = reader.count(least_field); n > 0; --n) {
    const std::string_view name = reader.text();
    const auto offset = reader.number<std::uint32_t>();
    const std::size_t type = reader.number<std::uint8_t>();
    static_cast<void>(reader.number<std::uint32_t>());  // Values; the first one is taken.
    const auto use = use_of(name);
    if (!use) continue;
    if (type < 1 || type > types)
      reader.refuse(fmt::format("the field '{}' is of type {}; there are 1 to {}", shown(name), type, types));
    fields.at(*use) = CloudField{offset, static_cast<Scalar>(type - 1)};
  }
  if (!fields[0] || !fields[1] || !fields[2]) reader.refuse("the cloud lacks one of the fields x, y and z");
  return fields;
}

struct CloudLayout {
  std::uint32_t height = 0, width = 0, point_step = 0, row_step = 0;
};

/// How long a point's time of 1 is, s. Whole numbers are ns. So are others that are too large for seconds:
/// Livox's drivers write stamps in ns as float64.
double unit_of_times(Scalar type, double latest) {
  constexpr double ns = 1e-9;
  return clouds::is_whole(type) || !fault_of_stamp(latest).empty() ? ns : 1.0;
}

void check_layout(const MessageReader& reader, const CloudLayout& layout, const CloudFields& fields,
                  std::size_t bytes) {
  for (const auto& field : fields) {
    if (field && field->offset + clouds::size_of(field->type) > layout.point_step)
      reader.refuse(fmt::format("a field at byte {} reaches beyond the point's {} bytes", field->offset,
                                layout.point_step));
  }
  // Products of 32 bits each: they cannot overflow.
  const std::uint64_t row = std::uint64_t{layout.width} * layout.point_step;
  if (layout.height > 1 && layout.row_step < row)
    reader.refuse(fmt::format("a row of {} points has {} bytes, which is less than they take", layout.width,
                              layout.row_step));
  const std::uint64_t needed =
      layout.height == 0 || layout.width == 0 ? 0 : std::uint64_t{layout.height - 1} * layout.row_step + row;
  if (needed > bytes)
    reader.refuse(fmt::format("{} rows of {} points take {} bytes, the message has {}", layout.height,
                              layout.width, needed, bytes));
}

}  // namespace

std::optional<Header> readable_header(const RecordedMessage& message) {
  try {
    MessageReader reader(message);
    return read_header(reader);
  } catch (const ConfigError&) {
    return std::nullopt;
  }
}

LaserScan read_laser_scan(const RecordedMessage& message) {
  MessageReader reader(message);
  LaserScan scan;
  scan.header = read_header(reader);
  for (float* value : {&scan.angle_min, &scan.angle_max, &scan.angle_increment, &scan.time_increment,
                       &scan.scan_time, &scan.range_min, &scan.range_max})
    *value = reader.number<float>();
  scan.ranges = reader.numbers<float>();
  if (!std::isfinite(scan.angle_min) || !std::isfinite(scan.angle_increment))
    reader.refuse(fmt::format("its angles begin at {} rad and grow by {} rad; both must be finite",
                              scan.angle_min, scan.angle_increment));
  const double end = static_cast<double>(scan.time_increment) * static_cast<double>(scan.ranges.size());
  if (const std::string fault = fault_of_scan_times(0.0, end); !fault.empty()) reader.refuse(fault);
  return scan;
}

PointCloud read_point_cloud(const RecordedMessage& message) {
  MessageReader reader(message);
  PointCloud cloud;
  cloud.header = read_header(reader);
  CloudLayout layout;
  layout.height = reader.number<std::uint32_t>();
  layout.width = reader.number<std::uint32_t>();
  const CloudFields fields = read_cloud_fields(reader);
  const std::endian order = reader.number<std::uint8_t>() != 0 ? std::endian::big : std::endian::little;
  layout.point_step = reader.number<std::uint32_t>();
  layout.row_step = reader.number<std::uint32_t>();
  const std::string_view data = reader.bytes();
  check_layout(reader, layout, fields, data.size());
  if (layout.width == 0) return cloud;  // Rows without points need no bytes: billions may be announced.
  for (std::uint32_t row = 0; row < layout.height; ++row) {
    for (std::uint32_t column = 0; column < layout.width; ++column) {
      const char* const point =
          data.data() + std::size_t{row} * layout.row_step + std::size_t{column} * layout.point_step;
      const auto value = [&](const CloudField& field) {
        return clouds::number_at(point + field.offset, field.type, order);
      };
      const double x = value(*fields[0]), y = value(*fields[1]), z = value(*fields[2]);
      const double time = fields[3] ? value(*fields[3]) : 0.0;
      const auto is_place = [](double v) { return std::abs(v) <= farthest_m; };
      if (!is_place(x) || !is_place(y) || !is_place(z) || !std::isfinite(time)) {
        ++cloud.left_out;
        continue;
      }
      cloud.points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
      if (fields[3]) cloud.times.push_back(time);
    }
  }
  if (cloud.times.empty()) return cloud;
  const auto [first, last] = std::minmax_element(cloud.times.begin(), cloud.times.end());
  const double unit = unit_of_times(fields[3]->type, *last);
  if (const std::string fault = fault_of_scan_times(unit * *first, unit * *last); !fault.empty())
    reader.refuse(fault);
  for (double& time : cloud.times) time *= unit;
  return cloud;
}

Odometry read_odometry(const RecordedMessage& message) {
  MessageReader reader(message);
  Odometry odometry;
  odometry.header = read_header(reader);
  odometry.child_frame = frame_name(reader.text());
  odometry.frame_from_child = read_rigid_motion(reader);
  return odometry;
}

std::vector<FrameTransform> read_transforms(const RecordedMessage& message) {
  MessageReader reader(message);
  constexpr std::size_t least_transform = 72;
  std::vector<FrameTransform> transforms(reader.count(least_transform));
  for (FrameTransform& transform : transforms) {
    transform.header = read_header(reader);
    transform.child_frame = frame_name(reader.text());
    transform.parent_from_child = read_rigid_motion(reader);
  }
  return transforms;
}

bool has_transforms(std::string_view type) {
  return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}

StampedFramePose read_pose(const RecordedMessage& message) {
  MessageReader reader(message);
  StampedFramePose pose;
  pose.header = read_header(reader);
  pose.pose = read_rigid_motion(reader);
  if (message.connection->type != "geometry_msgs/PoseWithCovarianceStamped") return pose;
  for (std::size_t i = 0; i < covariance_values; ++i) pose.covariance.push_back(reader.number<double>());
  return pose;
}

bool is_pose(std::string_view type) {
  return type == "geometry_msgs/PoseStamped" || type == "geometry_msgs/PoseWithCovarianceStamped";
}

GridMessage read_occupancy_grid(const RecordedMessage& message) {
  MessageReader reader(message);
  GridMessage grid;
  grid.header = read_header(reader);
  static_cast<void>(reader.number<std::uint32_t>());  // When the map was loaded: s and ns.
  static_cast<void>(reader.number<std::uint32_t>());
  grid.resolution = reader.number<float>();
  grid.width = reader.number<std::uint32_t>();
  grid.height = reader.number<std::uint32_t>();
  grid.frame_from_grid = read_rigid_motion(reader);
  grid.cells = reader.numbers<std::int8_t>();
  if (const std::string fault = fault_of_resolution(grid.resolution); !fault.empty()) reader.refuse(fault);
  if (std::uint64_t{grid.width} * grid.height != grid.cells.size())
    reader.refuse(fmt::format("{} cells follow where {} x {} are announced", grid.cells.size(), grid.width,
                              grid.height));
  return grid;
}

}  // namespace glocal::bags
