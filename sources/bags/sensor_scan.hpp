// Scans as their messages have them, as ends of rays in the sensor's frame.
#pragma once

#include <vector>

#include "sources/bags/messages.hpp"

namespace glocal::bags {

/// Which readings count.
struct RangeLimits {
  double min_range = 0.1;    ///< m; nearer ones say nothing: dirt on the glass, or the robot itself.
  double max_range = 100.0;  ///< m; those from here on met nothing.
  double free_range = 8.0;   ///< m; so far the way of a reading without return is free.
  double voxel_size = 0.0;   ///< m; of clouds: side of the cubes whose points become one. 0: all stay.
};

struct SensorScan {
  Points hits;       ///< m
  Points free_ends;  ///< m
  /// s after the header's stamp, one for each; empty if all are of one moment, or nobody knows.
  std::vector<float> hit_times, free_times;
};

/// Infinite readings and those from max_range on (the parameter or the message's) met nothing; others outside
/// of the message's range, negative ones and NaN say nothing (REP 117).
[[nodiscard]] SensorScan rays_of(const LaserScan& scan, const RangeLimits& limits);

/// Of a cloud's points; those of no return are not in it. Times more than a second off the stamp are taken to
/// be the driver's own clock, of which nothing is known but its differences: the first point then has the
/// stamp.
[[nodiscard]] SensorScan rays_of(const PointCloud& cloud, const RangeLimits& limits);

}  // namespace glocal::bags
