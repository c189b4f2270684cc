// How far a run is.
#pragma once

#include <cstddef>
#include <optional>

namespace glocal {

/// Of all variants of a run.
struct RunProgress {
  std::size_t finished = 0, trials = 0;
  std::optional<double> remaining_s = {};  ///< None as long as it cannot be told.
};

}  // namespace glocal
