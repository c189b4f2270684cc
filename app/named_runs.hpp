// Runs that are named on the command line, by the folders that hold their results.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal::app {

/// The folder's own name, whatever way it was written.
[[nodiscard]] std::string own_name(const std::filesystem::path& folder);

/// The results in folders that are results, or hold some, as `read` reads each, in the same order. Throws
/// ConfigError with every fault of all of them.
[[nodiscard]] std::vector<NamedRun> read_runs(
    const std::vector<std::string>& folders,
    const std::function<StoredRun(const std::filesystem::path&)>& read =
        [](const std::filesystem::path& folder) { return read_results(folder); });

/// The runs of an experiment that were left in one folder, but for their steps, which are most of them.
/// Throws ConfigError as read_runs() does.
[[nodiscard]] std::vector<NamedRun> read_sweep(const std::string& folder);

/// The run with that name, or the only one of the experiment with that name; the first without a name. Throws
/// ConfigError.
[[nodiscard]] std::size_t find_baseline(const std::vector<NamedRun>& runs, const std::string& name);

}  // namespace glocal::app
