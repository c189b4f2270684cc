// Folders of results on the command line.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/results/fault_collector.hpp"

namespace glocal::app {

/// Hands over each folder of results that `paths` are or hold; none may be named twice. Faults of all of
/// them, and those that `work` throws, are collected.
void for_each_results_folder(const std::vector<std::string>& paths, FaultCollector& faults,
                             const std::function<void(const std::filesystem::path&)>& work);

}  // namespace glocal::app
