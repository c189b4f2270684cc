#include "range_scan.hpp"

#include <mrpt/maps/CPointsMap.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "glocal/pose2.hpp"

namespace glocal::mrpt_plugin {
namespace {

constexpr double most_off = radians(0.01);

struct Ray {
  double angle = 0.0;  ///< rad, from the robot's heading on, in [-pi, 3 pi].
  double range = 0.0;  ///< m
  bool is_hit = false;
};

void add_rays(std::vector<Ray>& rays, const Points& ends, const Point& origin, bool are_hits) {
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double dx = double{ends.x[i]} - origin.x;
    const double dy = double{ends.y[i]} - origin.y;
    const double range = std::hypot(dx, dy);
    if (!std::isfinite(range) || range == 0.0) continue;
    rays.push_back({std::atan2(dy, dx), range, are_hits});
  }
}

/// By angle, from behind the widest gap on: a fan may lie across the robot's back.
void sort_as_fan(std::vector<Ray>& rays) {
  std::sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) { return a.angle < b.angle; });
  double widest = rays.front().angle + 2.0 * std::numbers::pi - rays.back().angle;
  std::size_t first = 0;
  for (std::size_t i = 1; i < rays.size(); ++i) {
    const double gap = rays[i].angle - rays[i - 1].angle;
    if (gap <= widest) continue;
    widest = gap;
    first = i;
  }
  const auto middle = rays.begin() + static_cast<std::ptrdiff_t>(first);
  std::for_each(rays.begin(), middle, [](Ray& ray) { ray.angle += 2.0 * std::numbers::pi; });
  std::rotate(rays.begin(), middle, rays.end());
}

/// Equal angles from `first` on.
struct Fan {
  double first = 0.0;      ///< rad
  double increment = 0.0;  ///< rad
  std::size_t rays = 0;

  [[nodiscard]] std::size_t nearest(double angle) const {
    return static_cast<std::size_t>(std::lround((angle - first) / increment));
  }
  [[nodiscard]] double off(double angle) const {
    return std::abs(angle - first - static_cast<double>(nearest(angle)) * increment);
  }
};

/// About `increment` wide steps from the first to the last ray; at least one.
Fan fan_over(const std::vector<Ray>& rays, double increment) {
  const double first = rays.front().angle;
  const double span = rays.back().angle - first;
  if (span <= most_off) return {first, increment, 2};
  const double steps = std::max(1.0, std::round(span / increment));
  return {first, span / steps, static_cast<std::size_t>(steps) + 1};
}

Fan fan_through(const std::vector<Ray>& rays) {
  double increment = std::numbers::pi;
  for (std::size_t i = 1; i < rays.size(); ++i) {
    const double step = rays[i].angle - rays[i - 1].angle;
    if (step > 2.0 * most_off) increment = std::min(increment, step);
  }
  Fan fan = fan_over(rays, increment);
  const auto misses = [&](const Ray& ray) { return fan.off(ray.angle) > most_off; };
  while (std::any_of(rays.begin(), rays.end(), misses)) {
    increment /= 2.0;
    fan = fan_over(rays, increment);
  }
  return fan;
}

}  // namespace

mrpt::obs::CObservation2DRangeScan::Ptr mrpt_scan(const Scan& scan) {
  auto made = mrpt::obs::CObservation2DRangeScan::Create();
  std::vector<Ray> rays;
  add_rays(rays, scan.hits, scan.origin, true);
  add_rays(rays, scan.free_ends, scan.origin, false);
  if (rays.empty()) return made;
  sort_as_fan(rays);
  const Fan fan = fan_through(rays);
  const double aperture = static_cast<double>(fan.rays - 1) * fan.increment;
  made->aperture = static_cast<float>(aperture);
  made->rightToLeft = true;
  made->sensorPose = {scan.origin.x, scan.origin.y, 0.0, wrap_angle(fan.first + aperture / 2.0), 0.0, 0.0};
  // Beyond all of them, but not by far: MRPT works out where rays end that met nothing, too.
  const auto farther = [](const Ray& a, const Ray& b) { return a.range < b.range; };
  made->maxRange = 2.0F * static_cast<float>(std::max_element(rays.begin(), rays.end(), farther)->range);
  made->resizeScanAndAssign(fan.rays, made->maxRange, false);
  for (const Ray& ray : rays) {
    const std::size_t i = fan.nearest(ray.angle);
    const auto range = static_cast<float>(ray.range);
    if (!ray.is_hit || range >= made->getScanRange(i)) continue;
    made->setScanRange(i, range);
    made->setScanRangeValidity(i, true);
  }
  // Of hits that are close together MRPT takes one, and none that follows a ray without a hit: that is right
  // for rays of a laser, but not where most of them are none.
  if (fan.rays > 2 * rays.size()) {
    mrpt::maps::CPointsMap::TInsertionOptions all;
    all.minDistBetweenLaserPoints = 0.0F;
    all.isPlanarMap = true;
    (void)made->buildAuxPointsMap<mrpt::maps::CPointsMap>(&all);
  }
  return made;
}

}  // namespace glocal::mrpt_plugin
