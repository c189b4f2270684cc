// All faults of several pieces of work, for one report.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "glocal/error.hpp"

namespace glocal {

class FaultCollector {
 public:
  /// Does some work; false if it threw a ConfigError, whose faults are kept then, the same ones once.
  template <class Work>
  bool collect(const Work& work) {
    try {
      work();
      return true;
    } catch (const ConfigError& error) {
      for (const Fault& fault : error.faults()) add(fault);
      return false;
    }
  }

  void add(const Fault& fault) {
    if (std::find(faults_.begin(), faults_.end(), fault) == faults_.end()) faults_.push_back(fault);
  }

  /// Throws ConfigError with all that was found, if there is anything.
  void report() {
    if (!faults_.empty()) throw ConfigError(std::move(faults_));
  }

 private:
  std::vector<Fault> faults_;
};

}  // namespace glocal
