#include "sources/simulation/lidar_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "glocal/error.hpp"

namespace glocal::simulation {

LidarSimulation::LidarSimulation(const Params& params, const SourceSetup& setup)
    : LidarSimulation(params, setup, planned_drive(params, setup)) {}

LidarSimulation::LidarSimulation(const Params& params, const SourceSetup& setup, PlannedDrive drive)
    : lidar_(params.lidar),
      step_seconds_(params.step_seconds),
      file_(params.world.resolved.string()),
      world_(std::move(drive.world)),
      scene_(world_, std::move(drive.cloud)),
      robot_(std::move(drive.route), params, setup.seed),
      swaying_(lidar_.tilt_deg, robot_.stream(DriveStream::sway, 0)) {
  check_height();
  check_ways();
}

std::optional<Sample> LidarSimulation::next() {
  const std::optional<DriveStep> step = robot_.next();
  if (!step) return std::nullopt;
  scene_.look_around(lidar_.max_range + most_deviations * lidar_.noise, step->stamp);
  Scan scan = lidar_scan(
      lidar_, [&](double time) { return pose_at(*step, time); },
      [&](const Vector3& origin, const Vector3& direction) { return scene_.ray_distance(origin, direction); },
      robot_.stream(DriveStream::lidar, step->number));
  return Sample{{step->stamp, std::move(scan), odometry(*step)}, pose_at(*step, 0.0), 0};
}

Pose3 LidarSimulation::pose_at(const DriveStep& step, double time) const {
  const double share = time == 0.0 ? 0.0 : time / step_seconds_;
  const Pose2 above = step.map_from_last ? pose_between(*step.map_from_last, step.map_from_robot, 1.0 + share)
                                         : step.map_from_robot;
  return {{above.x, above.y, world_.floor + lidar_.height},
          composed(turn_about_z(above.theta), swaying_.at(static_cast<double>(step.number) + share))};
}

Pose3 LidarSimulation::odometry(const DriveStep& step) const {
  Rng rng = robot_.stream(DriveStream::tilt, step.number);
  const double roll = rng.normal(radians(lidar_.tilt_noise_deg));
  const double pitch = rng.normal(radians(lidar_.tilt_noise_deg));
  const Pose2& planar = step.odom_from_robot;
  return {{planar.x, planar.y, 0.0},
          composed(composed(turn_about_z(planar.theta), swaying_.at(static_cast<double>(step.number))),
                   exponential({roll, pitch, 0.0}))};
}

void LidarSimulation::check_height() const {
  if (world_.ceiling == 0.0 || lidar_.height < world_.ceiling) return;
  throw ConfigError(
      file_, fmt::format("ceiling: a lidar at a height of {} m is not below the ceiling of {} m; lower "
                         "lidar.height, or raise the ceiling",
                         lidar_.height, world_.ceiling));
}

/// A robot cannot drive through points either.
void LidarSimulation::check_ways() const {
  const Route& route = robot_.route();
  for (std::size_t i = 1; i < route.poses.size(); ++i) {
    if (std::binary_search(route.carried.begin(), route.carried.end(), i)) continue;
    const Pose2& from = route.poses[i - 1];
    const Pose2& to = route.poses[i];
    const double way = distance(from, to);
    if (way == 0.0) continue;
    const Vector3 origin{from.x, from.y, world_.floor + lidar_.height};
    const Vector3 direction{(to.x - from.x) / way, (to.y - from.y) / way, 0.0};
    if (scene_.cloud_distance(origin, direction, way) == std::numeric_limits<double>::infinity()) continue;
    throw ConfigError(file_,
                      fmt::format("way_points: {} m over the floor the way from [{:.2f}, {:.2f}] to [{:.2f}, "
                                  "{:.2f}] meets a point of the cloud; move the way points, or change floor",
                                  lidar_.height, from.x, from.y, to.x, to.y));
  }
}

}  // namespace glocal::simulation
