#include "sources/carmen/carmen_writer.hpp"

#include <fmt/format.h>

namespace glocal::carmen {
namespace {

std::string text(const Pose2& pose) {
  return fmt::format("{} {} {}", pose.x, pose.y, pose.theta);
}

/// ipc_time host logger_time
std::string origin_of_message(double stamp) {
  return fmt::format("{0:.6f} glocal {0:.6f}\n", stamp);
}

}  // namespace

std::string carmen_lines(const CarmenScan& scan) {
  std::string lines;
  if (scan.map_from_robot) {
    lines += fmt::format("TRUEPOS {} {} {}", text(*scan.map_from_robot * scan.robot_from_laser),
                         text(scan.odom_from_robot), origin_of_message(scan.stamp));
  }
  const double field_of_view = scan.angle_step * static_cast<double>(scan.ranges.size() - 1);
  lines += fmt::format("ROBOTLASER1 0 {} {} {} {} 0 0 {}", scan.start_angle, field_of_view, scan.angle_step,
                       scan.max_range, scan.ranges.size());
  for (const float range : scan.ranges) lines += fmt::format(" {}", range);
  lines += fmt::format(" 0 {} {} 0 0 0 0 0 {}", text(scan.odom_from_robot * scan.robot_from_laser),
                       text(scan.odom_from_robot), origin_of_message(scan.stamp));
  return lines;
}

}  // namespace glocal::carmen
