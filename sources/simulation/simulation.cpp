#include "sources/simulation/simulation.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "sources/carmen/carmen_log.hpp"
#include "sources/carmen/carmen_writer.hpp"
#include "sources/simulation/occupancy_ray.hpp"

namespace glocal::simulation {

Simulation::Simulation(const Params& params, const SourceSetup& setup)
    : Simulation(params, planned_drive(params, setup), setup.seed) {}

Simulation::Simulation(const Params& params, World world, std::uint64_t seed)
    : Simulation(params, drive_in(std::move(world), params, seed), seed) {}

Simulation::Simulation(const Params& params, PlannedDrive drive, std::uint64_t seed)
    : laser_(params.laser),
      scan_limits_(scan_limits(params.laser)),
      max_unknown_(params.max_unknown),
      world_(std::move(drive.world)),
      map_(std::move(drive.map)),
      origin_(drive.origin),
      reality_(shapes_in_reality(world_)),
      robot_(std::move(drive.route), params, seed) {}

std::optional<Sample> Simulation::next() {
  const std::optional<DriveStep> step = robot_.next();
  if (!step) return std::nullopt;
  const carmen::CarmenScan scan = measured(*step);
  return Sample{
      {scan.stamp, carmen::robot_scan(scan, scan_limits_), scan.odom_from_robot}, scan.map_from_robot, 0};
}

std::optional<Recording> Simulation::recording() const {
  auto log = std::make_unique<ParamsOf<carmen::CarmenLog::Params>>();
  log->value = scan_limits_;
  Recording recording{.file_name = "drive.log", .content = {}, .observations = 0, .source = {}};
  log->value.path = {recording.file_name, recording.file_name};
  recording.source = {"carmen_log", std::move(log)};
  DrivingRobot robot = robot_;
  robot.start_over();
  while (const auto step = robot.next()) {
    recording.content += carmen::carmen_lines(measured(*step));
    ++recording.observations;
  }
  return recording;
}

carmen::CarmenScan Simulation::measured(const DriveStep& step) const {
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
  carmen::CarmenScan scan = simulated_scan(laser_, step.map_from_robot, distance_to_anything,
                                           robot_.stream(DriveStream::laser, step.number));
  scan.stamp = step.stamp;
  scan.odom_from_robot = step.odom_from_robot;
  scan.map_from_robot->x += origin_.x();
  scan.map_from_robot->y += origin_.y();
  return scan;
}

}  // namespace glocal::simulation
