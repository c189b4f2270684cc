#include "sources/drive_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "glocal/error.hpp"
#include "sources/itinerary.hpp"

namespace glocal {
namespace {

constexpr double most_observations = 1e6;

/// Adds equal steps from the last pose to `target`, none larger than allowed by `size` of the largest.
void add_steps(std::vector<Pose2>& poses, const Pose2& target, double size) {
  if (static_cast<double>(poses.size()) + size > most_observations) {
    throw ConfigError({{"", 0, 0,
                        "simulation: the drive has more than a million observations; raise step_length and "
                        "step_turn_deg, or lower tour_legs"}});
  }
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

/// Turns towards a place, then drives there; no step is longer or turns more than the parameters allow.
void drive_to(const Position& place, const DriveParams& params, std::vector<Pose2>& poses) {
  const Pose2 from = poses.back();
  const double theta = heading({from.x, from.y}, place);
  const Pose2 turned{from.x, from.y, theta};
  add_steps(poses, turned, rotation_between(from, turned) / radians(params.step_turn_deg));
  const Pose2 target{place[0], place[1], theta};
  add_steps(poses, target, distance(from, target) / params.step_length);
}

Pose2 pose_after(const Kidnapping& kidnapping) {
  return {kidnapping.to[0], kidnapping.to[1], wrap_angle(radians(kidnapping.heading_deg))};
}

/// A robot cannot drive on through walls, nor be carried away from a drive that is over.
void check_kidnappings(const World& world, const DriveParams& params, const Route& route, double driven) {
  const Shapes reality = shapes_in_reality(world);
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < params.kidnappings.size(); ++i) {
    const Kidnapping& kidnapping = params.kidnappings[i];
    const auto refuse = [&](const std::string& why) {
      faults.push_back({params.world.resolved.string(), 0, 0, fmt::format("kidnappings[{}]: {}", i, why)});
    };
    if (i >= route.carried.size()) {
      refuse(fmt::format("the drive is over after {:.1f} m; lower after_m from {} m, or drive farther",
                         driven, kidnapping.after_m));
      continue;
    }
    const Position to{kidnapping.to[0], kidnapping.to[1]};
    Itinerary itinerary(world.way_points, 0, Rng(0));
    itinerary.go_on_near(to);
    const Position next = *itinerary.next();
    if (is_free_way(reality, to, next)) continue;
    refuse(
        fmt::format("the way from [{}, {}] to the nearest way point [{}, {}] meets a wall or thing, or has "
                    "no length; put the robot down elsewhere",
                    to[0], to[1], next[0], next[1]));
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
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

void describe(ParamVisitor& v, Kidnapping& p) {
  v.field("after_m", p.after_m,
          {.doc = "Way driven before the robot is carried away.", .unit = "m", .min = 0.0, .required = true});
  v.field("to", p.to,
          {.doc = "Where the robot is put down, [x, y]; from there it drives to the nearest way point.",
           .unit = "m",
           .min_items = 2,
           .max_items = 2,
           .required = true});
  v.field("heading_deg", p.heading_deg,
          {.doc = "Heading of the robot where it is put down.", .unit = "deg", .min = -360.0, .max = 360.0});
}

void describe(ParamVisitor& v, DriveParams& p) {
  v.field("world", p.world, {.doc = "File that describes the world and the drive.", .required = true});
  v.field("tour_legs", p.tour_legs,
          {.doc = "Number of ways of a random tour: each pair of consecutive way points is a way in both "
                  "directions, and ways meet where way points are equal. 0 drives the way points as they are "
                  "listed.",
           .min = 0,
           .max = 100000,
           .audience = Audience::expert});
  v.field("kidnappings", p.kidnappings,
          {.doc = "Where the robot is carried away, between two observations and unnoticed by odometry."});
  v.field("step_length", p.step_length,
          {.doc = "Largest way from observation to observation.", .unit = "m", .min = 0.001});
  v.field("step_turn_deg", p.step_turn_deg,
          {.doc = "Largest turn from observation to observation.", .unit = "deg", .min = 0.1, .max = 180.0});
  v.field("step_seconds", p.step_seconds,
          {.doc = "Time from observation to observation, in which people walk on.",
           .unit = "s",
           .min = 0.0,
           .audience = Audience::expert});
  v.field("laser", p.laser, {.doc = "A planar range finder."});
  v.field("lidar", p.lidar, {.doc = "A lidar of several beams, in place of the planar range finder."});
  v.field("odometry", p.odometry,
          {.doc = "How badly the robot's own motion is measured.", .audience = Audience::expert});
  v.require(std::is_sorted(p.kidnappings.begin(), p.kidnappings.end(),
                           [](const Kidnapping& a, const Kidnapping& b) { return a.after_m < b.after_m; }),
            "kidnappings", "must be in rising order of after_m");
  v.require(p.lidar.beams == 0 || p.laser == LaserParams{}, "laser",
            "must be left out where there is a lidar: a robot has one of the two");
  v.require(p.lidar.beams > 0 || p.lidar == LidarParams{}, "lidar", "must have beams, 1 or more");
  v.require(p.lidar.scan_time <= p.step_seconds, "lidar",
            "scan_time must be at most step_seconds: a scan is over before the next one begins");
}

Route route_of(const World& world, const DriveParams& params, Rng rng) {
  const std::vector<Position>& places = world.way_points;
  Itinerary itinerary(places, params.tour_legs, rng);
  Route route{{{places[0][0], places[0][1], heading(places[0], places[1])}}, {}};
  double driven = 0.0;
  auto kidnapping = params.kidnappings.begin();
  while (const std::optional<Position> place = itinerary.next()) {
    const std::size_t first_new = route.poses.size();
    drive_to(*place, params, route.poses);
    for (std::size_t i = first_new; i < route.poses.size(); ++i) {
      driven += distance(route.poses[i - 1], route.poses[i]);
      if (kidnapping == params.kidnappings.end() || driven < kidnapping->after_m) continue;
      route.poses.resize(i + 1);
      route.carried.push_back(i + 1);
      route.poses.push_back(pose_after(*kidnapping++));
      itinerary.go_on_near({route.poses.back().x, route.poses.back().y});
      break;
    }
  }
  check_kidnappings(world, params, route, driven);
  return route;
}

DrivingRobot::DrivingRobot(const World& world, const DriveParams& params, std::uint64_t seed)
    : odometry_(params.odometry),
      step_seconds_(params.step_seconds),
      rng_(seed),
      route_(route_of(world, params, rng_.stream({static_cast<std::uint64_t>(DriveStream::tour)}))) {}

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

DriveSimulator::DriveSimulator(const DriveParams& params, std::uint64_t seed)
    : laser_(params.laser),
      world_(read_world(params.world.resolved)),
      reality_(shapes_in_reality(world_)),
      robot_(world_, params, seed) {}

std::optional<CarmenScan> DriveSimulator::next() {
  const std::optional<DriveStep> step = robot_.next();
  if (!step) return std::nullopt;
  CarmenScan scan = measure(*step);
  scan.stamp = step->stamp;
  scan.odom_from_robot = step->odom_from_robot;
  return scan;
}

CarmenScan DriveSimulator::measure(const DriveStep& step) const {
  Shapes shapes = reality_;
  const std::vector<Circle> people = people_at(world_, step.stamp);
  shapes.circles.insert(shapes.circles.end(), people.begin(), people.end());
  const auto distance_to_shapes = [&](const Position& origin, const Position& direction) {
    return ray_distance(shapes, origin, direction);
  };
  return simulated_scan(laser_, step.map_from_robot, distance_to_shapes,
                        robot_.stream(DriveStream::laser, step.number));
}

}  // namespace glocal
