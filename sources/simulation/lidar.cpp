#include "sources/simulation/lidar.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace glocal::simulation {

void describe(ParamVisitor& v, LidarParams& p) {
  v.field("beams", p.beams, {.doc = "Number of beams, one above the other.", .min = 1, .max = 1024});
  v.field("vertical_fov_deg", p.vertical_fov_deg,
          {.doc = "Elevations of the lowest and the highest beam; a single beam is midway.",
           .unit = "deg",
           .min = -89.0,
           .max = 89.0,
           .min_items = 2,
           .max_items = 2});
  v.field("azimuth_step_deg", p.azimuth_step_deg,
          {.doc = "Angle from ray to ray of a beam.", .unit = "deg", .min = 0.01, .max = 180.0});
  v.field("max_range", p.max_range,
          {.doc = "What is farther away is not seen.", .unit = "m", .max = 1000.0, .above = 0.0});
  v.field("noise", p.noise, {.doc = "Standard deviation of a range.", .unit = "m", .min = 0.0, .max = 10.0});
  v.field("height", p.height,
          {.doc = "Height of the sensor over the floor.", .unit = "m", .max = 100.0, .above = 0.0});
  v.field("scan_time", p.scan_time,
          {.doc = "Time that a scan takes, up to its stamp: the robot drives on meanwhile, each point is "
                  "measured from where it is then, and has its time. 0 measures all at once.",
           .unit = "s",
           .min = 0.0,
           .max = 100.0});
  const std::vector<double>& fov = p.vertical_fov_deg;
  v.require(fov.size() != 2 || (p.beams > 1 ? fov[0] < fov[1] : fov[0] <= fov[1]), "vertical_fov_deg",
            "must be rising: the lowest beam first");
  v.require(p.min_range < p.max_range, "max_range", "must be above 0.5 m: what is nearer is not seen");
}

Scan lidar_scan(const LidarParams& lidar, const LidarPath& map_from_lidar,
                const SpatialRayDistance& ray_distance, Rng rng) {
  const auto [lowest, highest] = std::pair(lidar.vertical_fov_deg[0], lidar.vertical_fov_deg[1]);
  const double step_deg = lidar.beams > 1 ? (highest - lowest) / (lidar.beams - 1) : 0.0;
  const double first_deg = lidar.beams > 1 ? lowest : (lowest + highest) / 2.0;
  const int columns = static_cast<int>(std::floor(360.0 / lidar.azimuth_step_deg + 1e-9));
  Scan scan;
  for (int column = 0; column < columns; ++column) {
    const double azimuth = radians(column * lidar.azimuth_step_deg) - std::numbers::pi;
    const double time = lidar.scan_time * (static_cast<double>(column + 1) / columns - 1.0);
    const Pose3 pose = map_from_lidar(time);
    for (int beam = 0; beam < lidar.beams; ++beam) {
      const double elevation = radians(first_deg + beam * step_deg);
      const Vector3 direction{std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      double range = ray_distance(pose.translation(), pose.rotation * direction);
      // All numbers are drawn for every ray, so that what one of them meets changes no other.
      range += rng.normal(lidar.noise);
      const bool is_outlier = rng.uniform() < lidar.outliers;
      const double anything = rng.uniform(lidar.min_range, lidar.max_range);
      const bool is_dropped = rng.uniform() < lidar.dropped;
      const bool is_seen = range >= lidar.min_range && range <= lidar.max_range;
      if (!is_seen || is_dropped) continue;
      const Vector3 hit = (is_outlier ? anything : range) * direction;
      scan.hits.push_back(as_point(hit));
      if (lidar.scan_time > 0.0) scan.times.push_back(static_cast<float>(time));
    }
  }
  return scan;
}

Swaying::Swaying(double tilt_deg, Rng rng) {
  for (auto* waves : {&roll_, &pitch_}) {
    for (const double share : {0.5, 0.3, 0.2}) {
      const double steps = rng.uniform(10.0, 50.0);
      const double phase = rng.uniform(0.0, 2.0 * std::numbers::pi);
      waves->push_back({share * radians(tilt_deg), 2.0 * std::numbers::pi / steps, phase});
    }
  }
}

Quaternion Swaying::at(double steps) const {
  const auto sum = [steps](const std::vector<Wave>& waves) {
    double angle = 0.0;
    for (const Wave& wave : waves) angle += wave.size * std::sin(wave.frequency * steps + wave.phase);
    return angle;
  };
  return composed(exponential({0.0, sum(pitch_), 0.0}), exponential({sum(roll_), 0.0, 0.0}));
}

}  // namespace glocal::simulation
