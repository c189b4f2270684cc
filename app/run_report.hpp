// What commands that run experiments say at their end.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "glocal/run_experiment.hpp"

namespace glocal::app {

/// 0; 1 if a trial has failed, 3 if the run was stopped.
[[nodiscard]] int exit_code_of(const RunResult& result);

/// The figures of one run, from its summary.
void print_summary(const nlohmann::ordered_json& summary, const std::filesystem::path& folder);

/// One line for each variant: its name and its summary.
void print_table(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& variants,
                 const std::filesystem::path& folder);

/// One of these for a whole run, of which there is at least one variant.
void print_result(const RunResult& result);

}  // namespace glocal::app
