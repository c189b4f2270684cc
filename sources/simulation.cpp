#include "sources/simulation.hpp"

namespace glocal {

Simulation::Simulation(const Params& params, const SourceSetup& setup)
    : trust_(trust_in(params.laser)), simulator_(params, setup.seed) {
  setup.note_input(params.world.resolved);
}

std::optional<Sample> Simulation::next() {
  const std::optional<CarmenScan> scan = simulator_.next();
  if (!scan) return std::nullopt;
  return Sample{{scan->stamp, robot_scan(*scan, trust_), scan->odom_from_robot}, scan->map_from_robot, 0};
}

}  // namespace glocal
