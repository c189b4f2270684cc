// Messages, serialized as ROS 2 does it: little-endian CDR (OMG DDS-RTPS 2.2, chapter 10), version 1 of XCDR.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sources/bags/messages.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::bags {

/// Writes the fields of a message in order.
class CdrWriter {
 public:
  /// A number, aligned to its size.
  template <class T>
  CdrWriter& number(T value) {
    align(sizeof(T));
    append(&value, sizeof(T));
    return *this;
  }
  CdrWriter& text(std::string_view text);
  /// How many elements follow.
  CdrWriter& count(std::size_t n) { return number(static_cast<std::uint32_t>(n)); }
  /// A sequence of bytes, as it is.
  CdrWriter& bytes(std::string_view bytes);
  CdrWriter& header(const Header& header);
  /// geometry_msgs/Pose, Transform
  CdrWriter& rigid_motion(const Pose3& motion);

  /// CDR's encapsulation header, and what was written.
  [[nodiscard]] const std::string& message() const { return bytes_; }

 private:
  void align(std::size_t size);
  void append(const void* bytes, std::size_t n);

  std::string bytes_ = std::string("\0\1\0\0", 4);
};

[[nodiscard]] std::string serialized(const LaserScan& scan);
/// A cloud of x, y, z and, if they are known, times (s), all float32.
[[nodiscard]] std::string serialized(const PointCloud& cloud);
[[nodiscard]] std::string serialized(const std::vector<FrameTransform>& transforms);
/// Nothing is said of when it was loaded.
[[nodiscard]] std::string serialized(const GridMessage& grid);
/// geometry_msgs/PoseStamped; the covariance is left out.
[[nodiscard]] std::string serialized(const StampedFramePose& pose);

/// What ROS 2 calls a type of ROS 1: tf/tfMessage is tf2_msgs/TFMessage, and others keep their names.
[[nodiscard]] std::string type_in_ros2(const std::string& type);

/// A message of ROS 1 as ROS 2 has it: all fields but the headers' sequence numbers. Throws ConfigError for a
/// message that breaks its definition. Its type must be one of definition_of().
[[nodiscard]] std::string as_cdr(const RecordedMessage& ros1_message);

}  // namespace glocal::bags
