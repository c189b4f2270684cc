// Whether figures can be drawn of what a run left.
#pragma once

#include <cstddef>
#include <filesystem>

#include "evaluation/results/fault_collector.hpp"

namespace glocal::app {

/// Collects what is missing or damaged of all that figures.py reads of a folder of results. Local maps need
/// not be there: what is drawn from them is left out.
void check_figures_input(const std::filesystem::path& folder, std::size_t trial, FaultCollector& faults);

}  // namespace glocal::app
