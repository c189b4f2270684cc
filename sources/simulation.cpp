#include "sources/simulation.hpp"

#include "sources/log_drive.hpp"

namespace glocal {

Simulation::Simulation(const Params& params, const SourceSetup& setup) : simulator_(params, setup.seed) {
  setup.note_input(params.world.resolved);
}

std::optional<Sample> Simulation::next() {
  const std::optional<CarmenScan> scan = simulator_.next();
  if (!scan) return std::nullopt;
  // What a simulated laser does not see within its range is not there.
  LogParams trust;
  trust.min_range = 0.0;
  trust.max_range = scan->max_range;
  trust.free_range = scan->max_range;
  return Sample{{scan->stamp, robot_scan(*scan, trust), scan->odom_from_robot}, scan->map_from_robot, 0};
}

}  // namespace glocal
