// Runs grouped into methods, and their trials paired within case and seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal {

/// A method and its runs, one for each case and seed; a run that is the whole of its experiment is a method
/// of its own, without a case.
struct Method {
  struct Run {
    std::string case_name;
    std::uint64_t seed = 0;
    std::size_t index = 0;  ///< Among all runs.
  };
  std::string name;
  std::vector<Run> runs;
};

/// Methods in the order of their first runs. Those of one name, in different folders, go by these. Throws
/// ConfigError where PooledParts does.
[[nodiscard]] std::vector<Method> methods_of(const std::vector<NamedRun>& runs);

/// The trials that all methods have, paired within case and seed by their start. Where no method has two
/// seeds of a case, seeds may differ between methods.
struct PairedTrials {
  struct Cell {
    std::size_t case_number = 0;
    std::uint64_t seed = 0;
    std::vector<std::size_t> runs;  ///< Of each method.
  };
  struct Trial {
    std::size_t cell = 0;
    TrialStart start;
  };
  /// A start of a case: trials from `begin` up to `end` begin there.
  struct Place {
    std::size_t case_number = 0;
    std::int64_t sample = 0;
    std::size_t begin = 0, end = 0;
  };
  std::vector<std::string> cases;  ///< Their names, in the order of the runs.
  std::vector<Cell> cells;
  std::vector<Trial> trials;  ///< By place, cell and start.
  std::vector<Place> places;
  std::vector<std::vector<const TrialResult*>> results;  ///< Of each method, trial by trial.
  std::vector<std::string> left_out;  ///< Cases with seeds that only some methods have, in words.
};

/// What it returns is of `runs`, which must stay.
[[nodiscard]] PairedTrials pair_trials(const std::vector<NamedRun>& runs, const std::vector<Method>& methods);

/// Says of each run why it has no trial that all methods have, where there is none.
[[noreturn]] void refuse_unpaired(const std::vector<NamedRun>& runs, const std::vector<Method>& methods,
                                  const PairedTrials& paired);

}  // namespace glocal
