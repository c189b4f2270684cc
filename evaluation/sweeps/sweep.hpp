// The runs of an experiment that many settings were tried in.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/comparison/run_part.hpp"
#include "evaluation/results/results_folder.hpp"

namespace glocal {

/// A run, and which part of the whole it is.
struct SweepRun {
  std::size_t index = 0;  ///< Among all runs.
  std::string name;       ///< Of its folder.
  RunPart part;
  bool complete = true;
  const std::map<std::string, Setting>* effective;    ///< Effective values of the run …
  const std::map<TrialStart, TrialResult>* trials{};  ///< … and its trials.
};

/// Whether these runs are the parts of one sweep: whether sweep_of() takes them.
[[nodiscard]] bool is_sweep(const std::vector<NamedRun>& runs);

/// The parts of a sweep, in the order of the runs, which must stay. Throws ConfigError where they are none.
[[nodiscard]] std::vector<SweepRun> sweep_of(const std::vector<NamedRun>& runs);

}  // namespace glocal
