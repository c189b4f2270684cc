// CARMEN text logs: from the file to records, with nothing decided yet about how they are used.
//
// One message a line, fields separated by blanks, metres and radians; lines of other kinds and comments (#)
// are skipped:
//
//   FLASER n r_1 … r_n  laser_x laser_y laser_theta  odom_x odom_y odom_theta  ipc_time host logger_time
//   RLASER              the same for a laser that looks backwards
//   ROBOTLASER1 type start_angle field_of_view step max_range accuracy remission_mode  n r_1 … r_n  m s_1 …
//   s_m
//               laser_x laser_y laser_theta  robot_x robot_y robot_theta
//               tv rv forward_safety_distance side_safety_distance turn_axis  ipc_time host logger_time
//   ODOM x y theta tv rv acceleration  ipc_time host logger_time
//   TRUEPOS x y theta  odom_x odom_y odom_theta  ipc_time host logger_time
//   PARAM name value …
//
// FLASER and RLASER say nothing of angles: 180 degrees from right to left, the usual Sick LMS, in 180 / n
// degrees for an even number of readings and 180 / (n - 1) for an odd one. Start and step of ROBOTLASER1 are
// in rad. TRUEPOS is the reference pose of the laser for the scan line that follows it.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "glocal/pose2.hpp"

namespace glocal::carmen {

enum class CarmenLaser { flaser, rlaser, robotlaser1 };

struct CarmenScan {
  CarmenLaser laser = CarmenLaser::flaser;
  int line = 0;               ///< Where it is in the file, from 1.
  std::vector<float> ranges;  ///< m, as logged: also negative, infinite and NaN.
  double start_angle = 0.0;   ///< rad; direction of the first reading, in the laser's frame.
  double angle_step = 0.0;    ///< rad; from one reading to the next, counter-clockwise.
  double max_range = std::numeric_limits<double>::infinity();  ///< m; readings from here on met nothing.
  double stamp = 0.0;                                          ///< s
  Pose2 odom_from_robot;
  Pose2 robot_from_laser;
  std::optional<Pose2> map_from_robot;  ///< From TRUEPOS.
};

/// All scans of a log, in file order. Throws ConfigError with the faults found (at most 20): a file that
/// cannot be read, is empty or larger than 2 GB, a log without scans, lines with more or
/// fewer fields than they say or of over 10 MB, numbers that are none.
[[nodiscard]] std::vector<CarmenScan> read_carmen_log(const std::filesystem::path& file);

}  // namespace glocal::carmen
