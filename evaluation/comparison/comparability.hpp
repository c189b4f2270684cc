// Whether runs can be compared at all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/comparison/methods.hpp"

namespace glocal {

/// Why the times of two runs tell more of the machine than of the runs; none if they can be compared.
[[nodiscard]] std::optional<std::string> why_times_differ(const NamedRun& run, const NamedRun& baseline);

/// What stands against comparing methods, a sentence each: cases, seeds and starts left out, interrupted
/// runs, other limits, maps, observations or seeds, times of another machine (`with_times`), trials that
/// overlap, few places.
[[nodiscard]] std::vector<std::string> comparability_warnings(const std::vector<NamedRun>& runs,
                                                              const std::vector<Method>& methods,
                                                              std::size_t baseline,
                                                              const PairedTrials& paired, bool with_times);

}  // namespace glocal
