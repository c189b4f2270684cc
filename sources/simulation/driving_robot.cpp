#include "sources/simulation/driving_robot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace glocal::simulation
