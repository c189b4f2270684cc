// A whole experiment: everything loaded, then trial after trial.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/experiment.hpp"
#include "glocal/global_map.hpp"
#include "pipeline/drive.hpp"
#include "pipeline/trials.hpp"

namespace glocal {

/// What an experiment needs besides its configuration; shared read-only by all trials.
struct Prepared {
  std::shared_ptr<const GlobalMap> map;
  double map_build_ms = 0.0;
  Drive drive;
  std::vector<std::size_t> starts;         ///< Samples at which trials start.
  std::set<std::filesystem::path> inputs;  ///< Files that were read.
};

/// Loads map and drive and finds the starts. Throws ConfigError.
[[nodiscard]] Prepared prepare(const Experiment& experiment, const Catalog& catalog, const Warn& warn);

/// The localizer of an experiment on its map; files that its stages read are added to the inputs. Throws
/// ConfigError.
[[nodiscard]] Localizer make_localizer(const Experiment& experiment, const Catalog& catalog,
                                       Prepared& prepared);

/// Runs all trials in order, handing each finished one to `done`; false if stopped before the last.
bool run_trials(Localizer& localizer, const Experiment& experiment, const Prepared& prepared,
                const TrialCallbacks& callbacks, const std::function<void(const TrialRecord&)>& done);

}  // namespace glocal
