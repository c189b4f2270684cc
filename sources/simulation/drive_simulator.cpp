#include "sources/simulation/drive_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sources/simulation/occupancy_ray.hpp"

namespace glocal::simulation {

DrivingRobot::DrivingRobot(Route route, const DriveParams& params, std::uint64_t seed)
    : odometry_(params.odometry), step_seconds_(params.step_seconds), rng_(seed), route_(std::move(route)) {}

std::optional<DriveStep> DrivingRobot::next() {
  if (step_ == route_.poses.size()) return std::nullopt;
  DriveStep step;
  step.number = step_;
  step.stamp = static_cast<double>(step_) * step_seconds_;
  step.map_from_robot = route_.poses[step_];
  const bool is_carried = std::binary_search(route_.carried.begin(), route_.carried.end(), step_);
  if (step_ > 0 && !is_carried) {
    step.map_from_last = route_.poses[step_ - 1];
    odom_from_robot_ = odom_from_robot_ * measured_motion(*step.map_from_last, step.map_from_robot);
  }
  step.odom_from_robot = odom_from_robot_;
  ++step_;
  return step;
}

void DrivingRobot::start_over() {
  step_ = 0;
  odom_from_robot_ = {};
}

Rng DrivingRobot::stream(DriveStream stream, std::size_t step) const {
  return rng_.stream({static_cast<std::uint64_t>(stream), step});
}

Pose2 DrivingRobot::measured_motion(const Pose2& from, const Pose2& to) const {
  Rng rng = stream(DriveStream::odometry, step_);
  const Pose2 motion = inverse(from) * to;
  const double way = std::hypot(motion.x, motion.y);
  const double scale = 1.0 + odometry_.distance_bias + rng.normal(odometry_.distance_noise);
  const double turn_scale = 1.0 + odometry_.turn_bias + rng.normal(odometry_.turn_noise);
  const double yaw_per_m = radians(odometry_.yaw_bias_deg_per_m + rng.normal(odometry_.yaw_noise_deg_per_m));
  return {scale * motion.x, scale * motion.y, wrap_angle(turn_scale * motion.theta + yaw_per_m * way)};
}

DriveSimulator::DriveSimulator(const LaserDriveParams& params, const SourceSetup& setup)
    : DriveSimulator(params, setup.seed, planned_drive(params, setup)) {}

DriveSimulator::DriveSimulator(const LaserDriveParams& params, std::uint64_t seed, PlannedDrive drive)
    : laser_(params.laser),
      max_unknown_(params.max_unknown),
      world_(std::move(drive.world)),
      map_(std::move(drive.map)),
      origin_(drive.origin),
      reality_(shapes_in_reality(world_)),
      robot_(std::move(drive.route), params, seed) {}

std::optional<carmen::CarmenScan> DriveSimulator::next() {
  const std::optional<DriveStep> step = robot_.next();
  if (!step) return std::nullopt;
  carmen::CarmenScan scan = measure(*step);
  scan.stamp = step->stamp;
  scan.odom_from_robot = step->odom_from_robot;
  scan.map_from_robot->x += origin_.x();
  scan.map_from_robot->y += origin_.y();
  return scan;
}

carmen::CarmenScan DriveSimulator::measure(const DriveStep& step) const {
  // A map is looked at from beyond the last cell that matters, as rays stop before the cell they end in.
  const double reach = laser_.max_range + (map_ ? 2.0 * map_->resolution : 0.0);
  const double reach_of_things = reach + most_deviations * laser_.noise;
  const Shapes people{.circles = people_at(world_, step.stamp)};
  const auto distance_to_anything = [&](const Position& origin, const Position& direction) {
    const double thing = std::min(reality_.ray_distance(origin, direction, reach_of_things),
                                  ray_distance(people, origin, direction));
    if (!map_) return thing;
    return ray_distance(*map_, origin, direction, reach, max_unknown_, thing);
  };
  return simulated_scan(laser_, step.map_from_robot, distance_to_anything,
                        robot_.stream(DriveStream::laser, step.number));
}

}  // namespace glocal::simulation
