// The figures of trials that are over, from the files they left.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <vector>

#include "evaluation/results/results_folder.hpp"
#include "evaluation/results/summary.hpp"

namespace glocal {

/// Numbers of steps from `from` up to, but not including, `to`.
struct StepRange {
  std::size_t from = 0;
  std::size_t to = std::numeric_limits<std::size_t>::max();
};

/// Reads a results folder, and adds the figures of its trials to `figures`: the same that the run itself
/// summed up, with the times of the steps in range. Throws ConfigError as read_results() does.
StoredRun read_figures(const std::filesystem::path& folder, const StepRange& range,
                       std::vector<TrialFigures>& figures);

}  // namespace glocal
