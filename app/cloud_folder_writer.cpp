#include "app/cloud_folder_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "app/interrupts.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/results/pose_json.hpp"
#include "glocal/error.hpp"

namespace glocal::app {

void CloudFolderWriter::write(const conversion::DriveScan& scan) {
  if (is_interrupted()) throw RunError("interrupted; nothing is left of " + folder_.path().string());
  const auto* const cloud = std::get_if<bags::PointCloud>(&scan.rays);
  if (cloud == nullptr)
    throw ConfigError(file_,
                      "has planar scans, which are no clouds in space; name --out *.mcap or *.log, or choose "
                      "a topic with clouds with --scans");
  if (!robot_from_sensor_) robot_from_sensor_ = scan.robot_from_sensor;
  constexpr double tolerance = 1e-3;  // m, rad
  if (distance(*robot_from_sensor_, scan.robot_from_sensor) > tolerance ||
      rotation_between(*robot_from_sensor_, scan.robot_from_sensor) > tolerance)
    throw ConfigError(file_,
                      "has a sensor that moves on the robot, and a folder of clouds has one that is fixed; "
                      "name --out *.mcap");
  const std::string stamp =
      fmt::format("{}.{:06}", scan.stamp_ns / 1'000'000'000, scan.stamp_ns / 1000 % 1'000'000);
  folder_.append(below_ / (stamp + ".pcd"), pcd(cloud->points));
  const auto line = [&](const Pose3& pose) { return fmt::format("{} {}\n", stamp, tum_text(pose)); };
  folder_.append(below_ / "odometry.tum", line(scan.odom_from_robot));
  if (scan.map_from_robot) folder_.append(below_ / "reference.tum", line(*scan.map_from_robot));
}

std::string mount_yaml(const Pose3& robot_from_sensor) {
  const Eigen::Matrix3d m = robot_from_sensor.rotation.toRotationMatrix();
  return fmt::format(
      "{{x: {:.6g}, y: {:.6g}, z: {:.6g}, roll_deg: {:.6g}, pitch_deg: {:.6g}, yaw_deg: {:.6g}}}",
      robot_from_sensor.x, robot_from_sensor.y, robot_from_sensor.z, degrees(std::atan2(m(2, 1), m(2, 2))),
      degrees(std::asin(std::clamp(0.0 - m(2, 0), -1.0, 1.0))), degrees(std::atan2(m(1, 0), m(0, 0))));
}

}  // namespace glocal::app
