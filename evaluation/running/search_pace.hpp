// How much of a search a step has time for.
#pragma once

#include <optional>

#include "evaluation/running/experiment_loader.hpp"
#include "glocal/catalog.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// How many looks at points (localizer.looks_per_step) the searches of an experiment take in so many
/// milliseconds on this machine: by the median time of pieces of searches in its first trials. None where no
/// search there is long enough to tell. Throws StrategyError.
[[nodiscard]] std::optional<int> looks_within(double ms, Experiment experiment, const Catalog& catalog,
                                              LoadedExperiment& loaded);

}  // namespace glocal
