#include "sources/bags/sensor_scan.hpp"

#include <algorithm>
#include <cmath>

#include "sources/clouds/thinning.hpp"

namespace glocal::bags {
namespace {

double squared_range(const Point& p) {
  return static_cast<double>(p.x) * p.x + static_cast<double>(p.y) * p.y + static_cast<double>(p.z) * p.z;
}

/// What is to be taken off a cloud's times, s, so that they count from its stamp.
double origin_of(const PointCloud& cloud) {
  constexpr double longest_scan = 1.0;
  const auto [first, last] = std::minmax_element(cloud.times.begin(), cloud.times.end());
  if (std::max(std::abs(*first), std::abs(*last)) <= longest_scan) return 0.0;
  const double stamp = static_cast<double>(cloud.header.stamp_ns) / 1e9;
  const bool same_clock = std::abs(*first - stamp) <= longest_scan && std::abs(*last - stamp) <= longest_scan;
  return same_clock ? stamp : *first;
}

}  // namespace

SensorScan rays_of(const LaserScan& scan, const RangeLimits& limits) {
  const double max_range = std::min(limits.max_range, static_cast<double>(scan.range_max));
  const double min_range = std::max(limits.min_range, static_cast<double>(scan.range_min));
  const double free_range = std::min(limits.free_range, max_range);
  SensorScan rays;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    // Readings are in single precision, and so is the limit that they are set to.
    const bool no_return = range >= static_cast<float>(max_range);
    if (no_return ? free_range <= 0.0 : !(range >= min_range)) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const double reach = no_return ? free_range : range;
    const Point end{static_cast<float>(reach * std::cos(angle)), static_cast<float>(reach * std::sin(angle)),
                    0.0F};
    (no_return ? rays.free_ends : rays.hits).push_back(end);
    if (scan.time_increment != 0.0F)
      (no_return ? rays.free_times : rays.hit_times).push_back(static_cast<float>(i) * scan.time_increment);
  }
  return rays;
}

SensorScan rays_of(const PointCloud& cloud, const RangeLimits& limits) {
  const double least = limits.min_range * limits.min_range, most = limits.max_range * limits.max_range;
  const double origin = cloud.times.empty() ? 0.0 : origin_of(cloud);
  SensorScan rays;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const double squared = squared_range(cloud.points[i]);
    if (squared < least || squared >= most) continue;
    rays.hits.push_back(cloud.points[i]);
    if (!cloud.times.empty()) rays.hit_times.push_back(static_cast<float>(cloud.times[i] - origin));
  }
  if (limits.voxel_size > 0.0) clouds::thin_out(rays.hits, rays.hit_times, limits.voxel_size);
  return rays;
}

}  // namespace glocal::bags
