// From what a sensor measured to what a robot sees: rays moved to where the robot is at an observation's
// stamp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "glocal/observation.hpp"
#include "glocal/params.hpp"
#include "glocal/pose3.hpp"
#include "sources/bags/drive_contents.hpp"
#include "sources/bags/messages.hpp"
#include "sources/bags/sensor_scan.hpp"

namespace glocal::bags {

/// Poses are interpolated between two that are at most this far apart, and scans of several topics joined
/// that are, ns.
inline constexpr std::int64_t longest_gap_ns = 500'000'000;

/// Where stamps jump by more, a drive of its own begins, s.
inline constexpr double longest_pause = 60.0;

/// What to say of clouds where the motion is planar and no heights are given.
inline constexpr const char* clouds_need_heights =
    "has clouds, and the motion is planar: set heights, such as [0.2, 1.5], to those of the map's walls, or "
    "localizer.motion to upright";

/// The fields `odom_frame` and `base_frame`, for everything that reads robots' tf.
void describe_robot_frames(ParamVisitor& v, std::string& odom_frame, std::string& base_frame);

/// The fields `max_range`, `heights` and `voxel_size`, for everything that reads robots' scans, and their
/// rule.
void describe_rays(ParamVisitor& v, double& max_range, std::vector<double>& heights, double& voxel_size);

struct PlacingRule {
  /// Ends of rays between these heights above the robot's origin count, m; all if there are none.
  std::vector<double> heights = {};
  bool is_deskewed = true;  ///< Rays are moved as odometry says; else they keep their times.
  bool is_planar = true;    ///< Ends have no height.
  std::optional<Pose3> robot_from_sensor = {};  ///< None: tf has it.
};

class ScanPlacer {
 public:
  /// `contents` must outlive this.
  ScanPlacer(PlacingRule rule, DriveContents& contents) : rule_(std::move(rule)), contents_(contents) {}

  /// None where it is not known at this time.
  [[nodiscard]] std::optional<Pose3> robot_from_sensor(const std::string& frame, std::int64_t stamp_ns) const;

  /// Whether it is known where the robot and its sensor were until the end of a message.
  [[nodiscard]] bool can_place(const SensorScan& rays, const Header& header,
                               std::int64_t observation_ns) const;

  /// Adds the rays of a message, one of `of` that make an observation, to its scan. False where it cannot be
  /// placed.
  [[nodiscard]] bool add(const SensorScan& rays, const Header& header, std::int64_t observation_ns,
                         std::size_t of, Scan& scan) const;

 private:
  class RayMover;
  /// None where it is not known where the robot and its sensor were in this span of time, s after the stamp.
  [[nodiscard]] std::optional<RayMover> mover_of(const Header& header, std::int64_t observation_ns,
                                                 const std::pair<double, double>& span) const;

  PlacingRule rule_;
  DriveContents& contents_;
};

/// Reads a message of one of the types of has_scans(). Throws ConfigError where it breaks its definition.
[[nodiscard]] SensorScan read_rays(const RecordedMessage& message, const RangeLimits& limits);

/// Of measured rays: the earliest and the latest time, s after the stamp; both 0 where there is none.
[[nodiscard]] std::pair<double, double> time_span(const SensorScan& rays);

[[nodiscard]] std::int64_t nanoseconds(double seconds);
[[nodiscard]] double seconds(std::int64_t ns);

}  // namespace glocal::bags
