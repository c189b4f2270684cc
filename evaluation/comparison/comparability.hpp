// Whether runs can be compared at all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal {

/// Trials of one run, start by start.
using TrialsByStart = std::vector<const TrialResult*>;

/// Why the times of two runs tell more of the machine than of the runs, a sentence; none if they can be
/// compared.
[[nodiscard]] std::optional<std::string> why_times_differ(const NamedRun& run, const NamedRun& baseline);

/// What stands against comparing runs, a sentence each: interrupted runs, starts left out, other limits,
/// maps, observations or seeds, times of another machine, trials that overlap, few starts. `trials` are those
/// of each run at the shared `starts`.
[[nodiscard]] std::vector<std::string> comparability_warnings(const std::vector<NamedRun>& runs,
                                                              std::size_t baseline,
                                                              const std::vector<TrialStart>& starts,
                                                              const std::vector<TrialsByStart>& trials);

}  // namespace glocal
