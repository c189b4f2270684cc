// Definitions of messages that are written, as ROS 2's *.msg files have them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glocal::bags {

/// A field of a message.
struct MessageField {
  std::string_view type;     ///< Of an element: a number's, string, or another message's.
  bool is_sequence = false;  ///< Of any number of elements.
  std::size_t count = 1;     ///< Elements, where it is no sequence.
};
/// The fields of a type; none for a type that is not known. Types are named as in `sensor_msgs/LaserScan`.
[[nodiscard]] std::vector<MessageField> fields_of(std::string_view type);

/// The fields of a type and of all types in it, as MCAP's schema encoding ros2msg has them, without constants
/// and comments; empty for a type that is not known.
[[nodiscard]] std::string definition_of(std::string_view type);

/// `sensor_msgs/LaserScan` as ROS 2 names it: `sensor_msgs/msg/LaserScan`.
[[nodiscard]] std::string ros2_type(std::string_view type);

}  // namespace glocal::bags
