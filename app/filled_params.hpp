// Parameters without a file, from what the command line says.
#pragma once

#include <vector>

#include "config/node.hpp"
#include "glocal/experiment.hpp"
#include "glocal/params.hpp"

namespace glocal::app {

/// Fills parameters from a tree into which some values are put. Throws ConfigError with all faults.
void fill(AnyParams& params, YamlNode tree, const std::vector<Override>& values);

}  // namespace glocal::app
