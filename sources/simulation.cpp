#include "sources/simulation.hpp"

namespace glocal {

Simulation::Simulation(const Params& params, const SourceSetup& setup)
    : scan_limits_(scan_limits(params.laser)), simulator_(params, setup.seed) {
  setup.note_input(params.world.resolved);
}

std::optional<Sample> Simulation::next() {
  const std::optional<CarmenScan> scan = simulator_.next();
  if (!scan) return std::nullopt;
  return Sample{
      {scan->stamp, robot_scan(*scan, scan_limits_), scan->odom_from_robot}, scan->map_from_robot, 0};
}

}  // namespace glocal
