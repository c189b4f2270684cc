// A whole drive in memory, and where on it trials start.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/experiment.hpp"
#include "glocal/global_map.hpp"
#include "glocal/observation.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

struct Drive {
  std::vector<Sample> samples;
  std::vector<double> path_m;  ///< Way driven up to each sample, without the gaps between segments.
};

/// Reads a source to its end. The way is measured along odometry: reference poses jump where they were
/// corrected.
[[nodiscard]] Drive read_drive(ObservationSource& source);

/// Indexes of the samples at which trials start, ascending. Throws ConfigError if there are none.
[[nodiscard]] std::vector<std::size_t> trial_starts(const TrialsConfig& config, const Drive& drive,
                                                    const GlobalMap& map);

/// Those of all starts that `only` names. Throws ConfigError where it names one that is not there.
[[nodiscard]] std::vector<std::size_t> chosen_starts(const TrialsConfig& config,
                                                     const std::vector<std::size_t>& all);

/// The number that a trial's start has among all: it names the trial's random numbers.
[[nodiscard]] std::size_t start_number(const TrialsConfig& config, std::size_t trial);

}  // namespace glocal
