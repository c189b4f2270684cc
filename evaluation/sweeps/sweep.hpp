// The runs of an experiment that many settings were tried in.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/results/results_folder.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// A run, and which part of the whole it is.
struct SweepRun {
  std::string name;       ///< Of its folder.
  std::string setting;    ///< Empty if nothing but case and seed vary.
  std::string case_name;  ///< Empty without cases.
  CaseRole role = CaseRole::none;
  std::uint64_t seed = 0;
  bool complete = true;
  std::vector<std::pair<std::string, std::string>> values;  ///< What the setting changes: paths and values.
  const std::map<TrialStart, TrialResult>* trials;          ///< Of the run that this was made of.
};

/// Whether these runs are the parts of one sweep: whether sweep_of() takes them.
[[nodiscard]] bool is_sweep(const std::vector<NamedRun>& runs);

/// The parts of a sweep, in the order of the runs, which must stay. Throws ConfigError where they are none.
[[nodiscard]] std::vector<SweepRun> sweep_of(const std::vector<NamedRun>& runs);

}  // namespace glocal
