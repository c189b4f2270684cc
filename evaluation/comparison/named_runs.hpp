// Runs by the folders that hold their results, with names that tell them apart.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/results/fault_collector.hpp"

namespace glocal {

/// The folder's own name, whatever way it was written.
[[nodiscard]] std::string own_name(const std::filesystem::path& folder);

/// Hands over each folder of results that `paths` are or hold; none may be named twice. Faults of all of
/// them, and those that `work` throws, are collected.
void for_each_results_folder(const std::vector<std::string>& paths, FaultCollector& faults,
                             const std::function<void(const std::filesystem::path&)>& work);

/// The results in folders that are results, or hold some, as `read` reads each, in the same order: without it
/// what a comparison needs. Throws ConfigError with every fault of all of them.
[[nodiscard]] std::vector<NamedRun> read_runs(
    const std::vector<std::string>& folders,
    const std::function<StoredRun(const std::filesystem::path&)>& read =
        [](const std::filesystem::path& folder) { return read_results(folder, {}, ResultParts::times); });

/// Of the options of what is compared: a run of the method with that name, the run with that name, or the
/// only one of the experiment with that name; the first without a name. Throws ConfigError.
[[nodiscard]] std::size_t find_baseline(const std::vector<NamedRun>& runs, const std::string& name);

}  // namespace glocal
