// Times of runs, taken anew on this machine.
#pragma once

#include <vector>

#include "app/commands.hpp"
#include "evaluation/comparison/comparison.hpp"

namespace glocal::app {

/// Runs the experiments of stored runs again, trial by trial in turn, and puts the CPU times of their steps
/// in the place of the stored ones: what the machine does besides then falls on all of them. Throws
/// ConfigError where an experiment cannot be run again, or gives other answers than are stored.
void measure_times_anew(std::vector<NamedRun>& runs, bool trust_plugins, Context& context);

}  // namespace glocal::app
