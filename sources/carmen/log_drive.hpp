// The parts of a log that are used: segments of the driven path, thinned to keyframes, as scans in the
// robot's frame.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "glocal/observation.hpp"
#include "glocal/params.hpp"
#include "sources/carmen/carmen_parser.hpp"
#include "sources/driven_path.hpp"

namespace glocal::carmen {

/// Which scans of a log, and how much of them.
struct LogParams {
  FilePath path;
  std::string laser = "front";
  PathSegments segments{{0.0, 1.0}};
  KeyframeRule keyframes;
  double max_range = 20.0;
  double min_range = 0.1;
  double free_range = 8.0;
  double laser_yaw_deg = 0.0;
};
void describe(ParamVisitor& v, LogParams& p);
/// All but the ranges below which readings are dropped, and up to which the way of one without return is
/// free.
void describe_frames(ParamVisitor& v, LogParams& p);

/// A scan picked from a log.
struct LogFrame {
  std::size_t scan = 0;  ///< Index into LogDrive::scans.
  int segment = 0;
};

/// A log, and what of it was asked for.
struct LogDrive {
  std::vector<CarmenScan> scans;  ///< All of the wanted laser, in file order.
  std::vector<LogFrame> frames;
};

/// Reads a log and picks its keyframes. Throws ConfigError for an unusable log, a log without the wanted
/// laser, or a segment without scans.
[[nodiscard]] LogDrive read_log_drive(const LogParams& params);

/// Distance driven from the first scan to each, m, as the wheels have it: reference poses jump where they
/// were corrected.
[[nodiscard]] std::vector<double> path_lengths(const std::vector<CarmenScan>& scans);

/// The scan in the robot's frame: readings below min_range say nothing, readings of max_range or more,
/// negative, infinite and NaN ones met nothing.
[[nodiscard]] Scan robot_scan(const CarmenScan& scan, const LogParams& params);

}  // namespace glocal::carmen
