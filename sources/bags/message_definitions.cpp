#include "sources/bags/message_definitions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "sources/text_lines.hpp"

namespace glocal::bags {
namespace {

/// Common_msgs, as of ROS 2 Jazzy.
constexpr std::array<std::pair<std::string_view, std::string_view>, 25> definitions = {{
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/PoseWithCovarianceStamped",
     "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    {"geometry_msgs/PoseArray", "std_msgs/Header header\ngeometry_msgs/Pose[] poses\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"nav_msgs/MapMetaData",
     "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
     "geometry_msgs/Pose origin\n"},
    {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
     "float32[] ranges\nfloat32[] intensities\n"},
    {"std_msgs/Empty", "uint8 structure_needs_at_least_one_member\n"},
    {"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    {"diagnostic_msgs/DiagnosticStatus",
     "byte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n"},
    {"diagnostic_msgs/DiagnosticArray",
     "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"},
    {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
}};

std::string_view text_of_fields(std::string_view type) {
  const auto* const found = std::ranges::find_if(definitions, [&](const auto& d) { return d.first == type; });
  return found == definitions.end() ? std::string_view() : found->second;
}

/// "float64[36]"
MessageField field_of(std::string_view type) {
  const std::size_t bracket = type.find('[');
  if (bracket == std::string_view::npos) return {type};
  const std::string_view count = type.substr(bracket + 1, type.size() - bracket - 2);
  return {type.substr(0, bracket), count.empty(), whole_number_in(count).value_or(1)};
}

/// Adds the types in a type that are messages.
void add_parts(std::string_view type, std::vector<std::string_view>& parts) {
  for (const MessageField& field : fields_of(type)) {
    const bool is_known = std::ranges::find(parts, field.type) != parts.end();
    if (is_known || text_of_fields(field.type).empty()) continue;
    parts.push_back(field.type);
    add_parts(field.type, parts);
  }
}

}  // namespace

std::vector<MessageField> fields_of(std::string_view type) {
  std::vector<MessageField> fields;
  TextLines lines(text_of_fields(type));
  while (lines.next_with_fields()) fields.push_back(field_of(lines.fields().front()));
  return fields;
}

std::string definition_of(std::string_view type) {
  std::string definition(text_of_fields(type));
  if (definition.empty()) return definition;
  std::vector<std::string_view> parts;
  add_parts(type, parts);
  for (const std::string_view part : parts)
    definition += fmt::format("{:=>80}\nMSG: {}\n{}", "", part, text_of_fields(part));
  return definition;
}

std::string ros2_type(std::string_view type) {
  const std::size_t slash = type.find('/');
  if (slash == std::string_view::npos || type.find("/msg/") != std::string_view::npos)
    return std::string(type);
  return fmt::format("{}/msg{}", type.substr(0, slash), type.substr(slash));
}

}  // namespace glocal::bags
