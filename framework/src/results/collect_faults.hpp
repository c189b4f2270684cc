// Finding all faults of several inputs before giving up.
#pragma once

#include <vector>

#include "glocal/error.hpp"

namespace glocal {

/// Does the work; false if it threw a ConfigError, whose faults are then added to the others.
template <class Work>
bool collect_faults(std::vector<Fault>& faults, const Work& work) {
  try {
    work();
    return true;
  } catch (const ConfigError& error) {
    faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    return false;
  }
}

}  // namespace glocal
