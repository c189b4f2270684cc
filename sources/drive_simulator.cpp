#include "sources/drive_simulator.hpp"

#include <algorithm>
#include <cmath>

namespace glocal {
namespace {

enum Stream : std::uint64_t { laser_stream, odometry_stream };

/// Adds equal steps from the last pose to `target`, none larger than allowed by `size` of the largest.
void add_steps(std::vector<Pose2>& poses, const Pose2& target, double size) {
  const Pose2 from = poses.back();
  // A remainder that is only rounding makes no step of its own.
  const int steps = static_cast<int>(std::ceil(size - 1e-9));
  const double turn = wrap_angle(target.theta - from.theta);
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    poses.push_back({from.x + share * (target.x - from.x), from.y + share * (target.y - from.y),
                     wrap_angle(from.theta + share * turn)});
  }
}

double heading(const Position& from, const Position& to) {
  return std::atan2(to[1] - from[1], to[0] - from[0]);
}

}  // namespace

void describe(ParamVisitor& v, OdometryParams& p) {
  v.field("distance_bias", p.distance_bias,
          {.doc = "Constant error of a distance, as a share of it.", .min = -0.5, .max = 0.5});
  v.field("distance_noise", p.distance_noise,
          {.doc = "Standard deviation of a distance, as a share of it.", .min = 0.0});
  v.field("turn_bias", p.turn_bias,
          {.doc = "Constant error of a turn, as a share of it.", .min = -0.5, .max = 0.5});
  v.field("turn_noise", p.turn_noise, {.doc = "Standard deviation of a turn, as a share of it.", .min = 0.0});
  v.field("yaw_bias_deg_per_m", p.yaw_bias_deg_per_m,
          {.doc = "Constant turn that is measured when driving straight.", .unit = "deg/m"});
  v.field("yaw_noise_deg_per_m", p.yaw_noise_deg_per_m,
          {.doc = "Standard deviation of the turn that is measured when driving straight.",
           .unit = "deg/m",
           .min = 0.0});
}

void describe(ParamVisitor& v, DriveParams& p) {
  v.field("world", p.world, {.doc = "File that describes the world and the drive.", .required = true});
  v.field("step_length", p.step_length,
          {.doc = "Largest way from observation to observation.", .unit = "m", .min = 0.001});
  v.field("step_turn_deg", p.step_turn_deg,
          {.doc = "Largest turn from observation to observation.", .unit = "deg", .min = 0.1, .max = 180.0});
  v.field("step_seconds", p.step_seconds,
          {.doc = "Time from observation to observation, in which people walk on.", .unit = "s", .min = 0.0});
  v.field("laser", p.laser, {.doc = "The range finder."});
  v.field("odometry", p.odometry, {.doc = "How badly the robot's own motion is measured."});
}

std::vector<Pose2> drive_poses(const std::vector<Position>& way_points, double length, double turn) {
  std::vector<Pose2> poses{{way_points[0][0], way_points[0][1], heading(way_points[0], way_points[1])}};
  for (std::size_t i = 1; i < way_points.size(); ++i) {
    const double theta = heading(way_points[i - 1], way_points[i]);
    const Pose2 turned{poses.back().x, poses.back().y, theta};
    add_steps(poses, turned, rotation_between(poses.back(), turned) / turn);
    const Pose2 target{way_points[i][0], way_points[i][1], theta};
    add_steps(poses, target, distance(poses.back(), target) / length);
  }
  return poses;
}

DriveSimulator::DriveSimulator(const DriveParams& params, std::uint64_t seed)
    : params_(params),
      world_(read_world(params.world.resolved)),
      reality_(shapes_in_reality(world_)),
      poses_(drive_poses(world_.way_points, params.step_length, radians(params.step_turn_deg))),
      rng_(seed) {}

std::optional<CarmenScan> DriveSimulator::next() {
  if (step_ == poses_.size()) return std::nullopt;
  const Pose2& map_from_robot = poses_[step_];
  if (step_ > 0) odom_from_robot_ = odom_from_robot_ * measured_motion(poses_[step_ - 1], map_from_robot);
  const double stamp = static_cast<double>(step_) * params_.step_seconds;
  CarmenScan scan = measure(map_from_robot, stamp);
  scan.stamp = stamp;
  scan.odom_from_robot = odom_from_robot_;
  ++step_;
  return scan;
}

CarmenScan DriveSimulator::measure(const Pose2& map_from_robot, double time) const {
  Shapes shapes = reality_;
  const std::vector<Circle> people = people_at(world_, time);
  shapes.circles.insert(shapes.circles.end(), people.begin(), people.end());
  const auto distance_to_shapes = [&](const Position& origin, const Position& direction) {
    return ray_distance(shapes, origin, direction);
  };
  return simulated_scan(params_.laser, map_from_robot, distance_to_shapes,
                        rng_.stream({laser_stream, step_}));
}

Pose2 DriveSimulator::measured_motion(const Pose2& from, const Pose2& to) const {
  const OdometryParams& odometry = params_.odometry;
  Rng rng = rng_.stream({odometry_stream, step_});
  const Pose2 motion = inverse(from) * to;
  const double way = std::hypot(motion.x, motion.y);
  const double scale = 1.0 + odometry.distance_bias + rng.normal(odometry.distance_noise);
  const double turn_scale = 1.0 + odometry.turn_bias + rng.normal(odometry.turn_noise);
  const double yaw_per_m = radians(odometry.yaw_bias_deg_per_m + rng.normal(odometry.yaw_noise_deg_per_m));
  return {scale * motion.x, scale * motion.y, wrap_angle(turn_scale * motion.theta + yaw_per_m * way)};
}

}  // namespace glocal
