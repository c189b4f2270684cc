#include "sources/conversion/carmen_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/carmen/carmen_writer.hpp"
#include "sources/carmen/log_drive.hpp"

namespace glocal::conversion {
namespace {

using carmen::CarmenLaser;
using carmen::CarmenScan;

/// The laser's pose, if it is the same in all scans but for the six decimals that logs have.
std::optional<Pose3> fixed_pose(const std::vector<CarmenScan>& scans, bool rear) {
  constexpr double tolerance = 1e-5;  // m, rad
  std::optional<Pose2> first;
  for (const CarmenScan& scan : scans) {
    if ((scan.laser == CarmenLaser::rlaser) != rear) continue;
    const Pose2& pose = scan.robot_from_laser;
    if (!first) first = pose;
    if (distance(pose, *first) > tolerance || rotation_between(pose, *first) > tolerance) return std::nullopt;
  }
  return first ? std::optional<Pose3>(*first) : std::nullopt;
}

/// Where the sensor is, seen from above, and whether it is upside down.
struct LevelPose {
  Pose2 robot_from_sensor;
  bool is_upside_down = false;
};

LevelPose level_pose(const DriveScan& scan, const std::string& topic, const std::string& file) {
  constexpr double tolerance_deg = 1.0;
  const Pose3& pose = scan.robot_from_sensor;
  const double tilt_deg = degrees(pose.tilt());
  if (tilt_deg <= tolerance_deg) return {seen_from_above(pose), false};
  if (180.0 - tilt_deg > tolerance_deg)
    throw ConfigError(file,
                      fmt::format("the sensor of {} is tilted by {:.1f} deg, and lasers of a CARMEN log are "
                                  "level; convert to MCAP, or choose another topic with --scans",
                                  shown(topic), tilt_deg));
  const Pose3 half_turn(Quaternion{0.0, 1.0, 0.0, 0.0});  // About x.
  return {seen_from_above(pose * half_turn), true};
}

/// As a log has it.
float logged(float range, const bags::LaserScan& scan, double max_range) {
  if (range >= static_cast<float>(max_range)) return static_cast<float>(max_range);
  return range >= std::max(scan.range_min, 0.0F) ? range : 0.0F;
}

}  // namespace

bags::LaserScan laser_scan(const CarmenScan& scan, double max_range, const std::string& frame) {
  const double farthest = std::isfinite(scan.max_range) ? scan.max_range : max_range;
  bags::LaserScan out;
  out.header = {nanoseconds_of(scan.stamp), frame};
  out.angle_min = static_cast<float>(scan.start_angle);
  out.angle_max =
      static_cast<float>(scan.start_angle + scan.angle_step * static_cast<double>(scan.ranges.size() - 1));
  out.angle_increment = static_cast<float>(scan.angle_step);
  out.range_max = static_cast<float>(farthest);
  for (const float range : scan.ranges) {
    const bool met_nothing = !(range >= 0.0F && range < out.range_max);
    out.ranges.push_back(met_nothing ? std::numeric_limits<float>::infinity() : range);
  }
  return out;
}

CarmenScan carmen_scan(const DriveScan& scan, const DriveSensor& sensor, const std::string& file) {
  const auto* const laser = std::get_if<bags::LaserScan>(&scan.rays);
  if (laser == nullptr)
    throw ConfigError(
        file,
        "has clouds, which cannot be written as a CARMEN log: it has planar scans only; convert to MCAP "
        "or to a folder");
  const LevelPose level = level_pose(scan, sensor.topic, file);
  CarmenScan out;
  out.laser = CarmenLaser::robotlaser1;
  // Angles of floats are good to 1e-7 only.
  out.start_angle = laser->angle_min;
  out.angle_step = laser->angle_increment;
  // Some drivers do not say it.
  const bool has_range = std::isfinite(laser->range_max) && laser->range_max > 0.0F;
  out.max_range = has_range ? laser->range_max : sick_range;
  for (const float range : laser->ranges) out.ranges.push_back(logged(range, *laser, out.max_range));
  // A line of a log has at least one reading, and 0 says nothing.
  if (out.ranges.empty()) {
    out.ranges = {0.0F};
    out.angle_step = 1.0;
  }
  if (level.is_upside_down) {
    out.start_angle = -out.start_angle;
    out.angle_step = -out.angle_step;
  }
  const double span = out.angle_step * static_cast<double>(out.ranges.size() - 1);
  if (out.angle_step < 0.0) {
    out.start_angle += span;
    out.angle_step = -out.angle_step;
    std::ranges::reverse(out.ranges);
  }
  if (!(out.angle_step > 0.0) || std::abs(span) > 2.0 * std::numbers::pi + 1e-6)
    throw ConfigError(file,
                      fmt::format("a scan has {} readings over {:.1f} deg; a CARMEN log has some, within a "
                                  "turn; convert to MCAP",
                                  out.ranges.size(), degrees(std::abs(span))));
  out.stamp = static_cast<double>(scan.stamp_ns) / 1e9;
  out.odom_from_robot = seen_from_above(scan.odom_from_robot);
  out.robot_from_laser = level.robot_from_sensor;
  if (scan.map_from_robot) out.map_from_robot = seen_from_above(*scan.map_from_robot);
  return out;
}

CarmenDriveReader::CarmenDriveReader(const std::filesystem::path& file, double max_range)
    : max_range_(max_range), scans_(carmen::read_carmen_log(file)) {
  for (const CarmenScan& scan : scans_) check_stamp(scan.stamp, file.string(), scan.line);
  const auto has = [&](CarmenLaser laser) {
    return std::ranges::any_of(scans_, [&](const CarmenScan& s) { return s.laser == laser; });
  };
  if (has(CarmenLaser::flaser))
    std::erase_if(scans_, [](const CarmenScan& s) { return s.laser == CarmenLaser::robotlaser1; });
  if (has(CarmenLaser::flaser) || has(CarmenLaser::robotlaser1))
    sensors_.push_back({"/scan", "laser", false, fixed_pose(scans_, false)});
  if (has(CarmenLaser::rlaser))
    sensors_.push_back({"/scan_rear", "laser_rear", false, fixed_pose(scans_, true)});
}

std::optional<DriveScan> CarmenDriveReader::next() {
  if (next_ == scans_.size()) return std::nullopt;
  const CarmenScan& scan = scans_[next_++];
  DriveScan out;
  out.sensor = scan.laser == CarmenLaser::rlaser ? sensors_.size() - 1 : 0;
  out.stamp_ns = nanoseconds_of(scan.stamp);
  out.odom_from_robot = scan.odom_from_robot;
  out.robot_from_sensor = scan.robot_from_laser;
  if (scan.map_from_robot) out.map_from_robot = *scan.map_from_robot;
  out.rays = laser_scan(scan, max_range_, sensors_[out.sensor].frame);
  return out;
}

void CarmenDriveWriter::write(const DriveScan& scan) {
  constexpr std::size_t enough = 1U << 20U;
  lines_ += carmen::carmen_lines(carmen_scan(scan, sensors_[scan.sensor], file_));
  if (lines_.size() >= enough) finish();
}

void CarmenDriveWriter::finish() {
  sink_(lines_);
  lines_.clear();
}

}  // namespace glocal::conversion
