#include "sources/simulation/laser.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glocal::simulation {

void describe(ParamVisitor& v, LaserParams& p) {
  v.field("fov_deg", p.fov_deg,
          {.doc = "Angle between the first ray and the last.", .unit = "deg", .max = 360.0, .above = 0.0});
  v.field("step_deg", p.step_deg,
          {.doc = "Angle from ray to ray.", .unit = "deg", .min = 0.01, .max = 360.0});
  v.field("max_range", p.max_range,
          {.doc = "Range of the laser: what is farther away is not seen.",
           .unit = "m",
           .max = 1000.0,
           .above = 0.0});
  v.field("noise", p.noise,
          {.doc = "Standard deviation of a reading.", .unit = "m", .min = 0.0, .max = 10.0});
  v.require(p.step_deg <= p.fov_deg, "step_deg", "must not be above fov_deg");
}

carmen::CarmenScan simulated_scan(const LaserParams& laser, const Pose2& map_from_robot,
                                  const RayDistance& ray_distance, Rng rng) {
  carmen::CarmenScan scan;
  scan.laser = carmen::CarmenLaser::robotlaser1;
  scan.start_angle = -radians(laser.fov_deg) / 2.0;
  scan.angle_step = radians(laser.step_deg);
  scan.max_range = laser.max_range;
  scan.robot_from_laser = {laser.x, laser.y, wrap_angle(radians(laser.yaw_deg))};
  scan.map_from_robot = map_from_robot;
  const Pose2 map_from_laser = map_from_robot * scan.robot_from_laser;
  scan.ranges.resize(static_cast<std::size_t>(std::floor(laser.fov_deg / laser.step_deg + 1e-9)) + 1);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle =
        map_from_laser.theta + radians(static_cast<double>(i) * laser.step_deg - laser.fov_deg / 2.0);
    double range = ray_distance({map_from_laser.x, map_from_laser.y}, {std::cos(angle), std::sin(angle)});
    const bool known = !std::isnan(range);
    range += rng.normal(laser.noise);
    if (rng.uniform() < laser.outliers) range = rng.uniform(0.0, laser.max_range);
    scan.ranges[i] = known ? static_cast<float>(std::clamp(range, 0.0, laser.max_range)) : 0.0F;
  }
  return scan;
}

carmen::LogParams scan_limits(const LaserParams& laser) {
  carmen::LogParams limits;
  limits.keyframes = {0.0, 0.0};
  limits.min_range = 1e-6;  // 0 says nothing
  limits.max_range = laser.max_range;
  limits.free_range = laser.max_range;
  return limits;
}

}  // namespace glocal::simulation
