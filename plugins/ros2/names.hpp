// What ROS 2 calls topics and types, and what these are in DDS.
#pragma once

#include <dds/dds.h>

#include <optional>
#include <string>
#include <string_view>

#include "glocal/message_link.hpp"

namespace glocal::ros2_plugin {

/// `rt/scan` for `/scan`. Throws ConfigError for what is no name of a topic.
[[nodiscard]] std::string dds_topic(const std::string& topic);

/// `/scan` for `rt/scan`; none for what is no topic of ROS, as requests to services.
[[nodiscard]] std::optional<std::string> ros_topic(std::string_view dds_topic);

/// `sensor_msgs/LaserScan` for `sensor_msgs::msg::dds_::LaserScan_`; other types are called as in DDS.
[[nodiscard]] std::string ros_type(std::string_view dds_type);

/// How messages of the topic's type are laid out. Throws ConfigError for a type that is not known.
[[nodiscard]] const dds_topic_descriptor_t& layout_of(const LiveTopic& topic);

}  // namespace glocal::ros2_plugin
