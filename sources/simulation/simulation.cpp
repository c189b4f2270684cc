#include "sources/simulation/simulation.hpp"

#include <memory>
#include <utility>

#include "sources/carmen/carmen_log.hpp"
#include "sources/carmen/carmen_writer.hpp"

namespace glocal::simulation {

Simulation::Simulation(const Params& params, const SourceSetup& setup)
    : scan_limits_(scan_limits(params.laser)), simulator_(params, setup) {}

Simulation::Simulation(const Params& params, World world, std::uint64_t seed)
    : scan_limits_(scan_limits(params.laser)),
      simulator_(params, seed, drive_in(std::move(world), params, seed)) {}

std::optional<Sample> Simulation::next() {
  const std::optional<carmen::CarmenScan> scan = simulator_.next();
  if (!scan) return std::nullopt;
  return Sample{
      {scan->stamp, carmen::robot_scan(*scan, scan_limits_), scan->odom_from_robot}, scan->map_from_robot, 0};
}

std::optional<Recording> Simulation::recording() const {
  auto log = std::make_unique<ParamsOf<carmen::CarmenLog::Params>>();
  log->value = scan_limits_;
  Recording recording{.file_name = "drive.log", .content = {}, .observations = 0, .source = {}};
  log->value.path = {recording.file_name, recording.file_name};
  recording.source = {"carmen_log", std::move(log)};
  DriveSimulator simulator = simulator_;
  simulator.start_over();
  while (const auto scan = simulator.next()) {
    recording.content += carmen::carmen_lines(*scan);
    ++recording.observations;
  }
  return recording;
}

}  // namespace glocal::simulation
