// What commands that run experiments say at their end.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "glocal/run_experiment.hpp"

namespace glocal::app {

/// 0; 1 if a trial has failed, 3 if the run was stopped.
[[nodiscard]] int exit_code_of(const RunResult& result);

/// The figures of one run, from its summary.
void print_summary(const nlohmann::ordered_json& summary, const std::filesystem::path& folder);

/// The figures of a whole run: those of its one variant, or a table of all of them.
void print_result(const RunResult& result);

}  // namespace glocal::app
