#include "names.hpp"

#include <messages.h>

#include <array>

#include "glocal/error.hpp"

namespace glocal::ros2_plugin {
namespace {

const std::array<const dds_topic_descriptor_t*, 11> layouts = {
    &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
    &geometry_msgs_msg_dds__PoseArray__desc,
    &geometry_msgs_msg_dds__PoseStamped__desc,
    &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc,
    &nav_msgs_msg_dds__OccupancyGrid__desc,
    &nav_msgs_msg_dds__Odometry__desc,
    &sensor_msgs_msg_dds__LaserScan__desc,
    &sensor_msgs_msg_dds__PointCloud2__desc,
    &std_msgs_msg_dds__Empty__desc,
    &std_msgs_msg_dds__String__desc,
    &tf2_msgs_msg_dds__TFMessage__desc,
};

bool is_ros_name(std::string_view topic) {
  constexpr std::string_view digits = "0123456789";
  constexpr std::string_view others = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
  char before = 'a';
  for (const char c : topic) {
    const bool begins = before == '/';
    const bool fits =
        c == '/' ? !begins : others.find(c) != others.npos || (!begins && digits.find(c) != digits.npos);
    if (!fits) return false;
    before = c;
  }
  return topic.starts_with('/') && before != '/';
}

}  // namespace

std::string dds_topic(const std::string& topic) {
  if (!is_ros_name(topic)) {
    throw ConfigError("",
                      "the topic '" + topic +
                          "' must be words of letters, digits and '_' that begin with no digit, each after "
                          "a '/': as /robot/scan");
  }
  return "rt" + topic;
}

std::optional<std::string> ros_topic(std::string_view dds_topic) {
  if (!dds_topic.starts_with("rt/")) return std::nullopt;
  return std::string(dds_topic.substr(2));
}

std::string ros_type(std::string_view dds_type) {
  constexpr std::string_view middle = "::msg::dds_::";
  const std::size_t at = dds_type.find(middle);
  if (at == std::string_view::npos || !dds_type.ends_with('_')) return std::string(dds_type);
  std::string_view name = dds_type.substr(at + middle.size());
  name.remove_suffix(1);
  return std::string(dds_type.substr(0, at)) + "/" + std::string(name);
}

const dds_topic_descriptor_t& layout_of(const LiveTopic& topic) {
  std::string known;
  for (const dds_topic_descriptor_t* layout : layouts) {
    const std::string type = ros_type(layout->m_typename);
    if (type == topic.type) return *layout;
    known += (known.empty() ? "" : ", ") + type;
  }
  throw ConfigError("", "the topic '" + topic.name + "': messages of the type '" + topic.type +
                            "' cannot be exchanged; there are " + known);
}

}  // namespace glocal::ros2_plugin
