// glocal map index: an index of a map, built once and saved for many runs.
#pragma once

#include <filesystem>

#include "glocal/catalog.hpp"
#include "glocal/experiment.hpp"
#include "glocal/strategies.hpp"

namespace glocal::app {

/// Saves the index that the experiment's matcher builds of this map, whatever index it names itself. Throws
/// ConfigError if the matcher has none that could be saved, or the file exists and may not be replaced.
[[nodiscard]] MapIndexInfo save_index(const Experiment& experiment, const Catalog& catalog, MapData map,
                                      const std::filesystem::path& file, bool replace);

}  // namespace glocal::app
