// A robot's messages, made of a CARMEN log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "glocal/pose3.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/bags/messages.hpp"
#include "sources/carmen/carmen_parser.hpp"

namespace glocal::test {

[[nodiscard]] inline std::int64_t stamp_ns(const carmen::CarmenScan& scan) {
  return static_cast<std::int64_t>(scan.stamp * 1e9);
}

/// A tf2_msgs/TFMessage with one transform.
[[nodiscard]] inline std::string transform(const std::string& parent, const std::string& child,
                                           std::int64_t stamp, const Pose3& pose) {
  return bags::Writer("cdr").number<std::uint32_t>(1).header(parent, stamp).text(child).pose(pose).bytes();
}

/// A sensor_msgs/LaserScan in the frame `laser`.
[[nodiscard]] inline std::string scan_message(const carmen::CarmenScan& scan) {
  bags::Writer w("cdr");
  const auto first = static_cast<float>(scan.start_angle), step = static_cast<float>(scan.angle_step);
  const auto last = first + static_cast<float>(scan.ranges.size() - 1) * step;
  w.header("laser", stamp_ns(scan));
  for (const float v : {first, last, step, 0.0F, 0.1F, 0.0F, static_cast<float>(scan.max_range)}) w.number(v);
  w.number(static_cast<std::uint32_t>(scan.ranges.size()));
  for (const float range : scan.ranges) w.number(range);
  return w.number<std::uint32_t>(0).bytes();
}

}  // namespace glocal::test
