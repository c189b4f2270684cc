// What glocal run says at its end.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace glocal::app {

/// The figures of one run, from its summary.
void print_summary(const nlohmann::ordered_json& summary, const std::filesystem::path& folder);

/// One line for each variant: its name and its summary.
void print_table(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& variants,
                 const std::filesystem::path& folder);

}  // namespace glocal::app
