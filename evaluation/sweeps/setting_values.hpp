// What settings change, in the same words however it was written.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/results/results_folder.hpp"

namespace glocal {

/// Paths of an experiment, and their values.
using SettingValues = std::vector<std::pair<std::string, std::string>>;

/// A setting with the effective values of one of its runs, by path.
struct SettingAsRun {
  SettingValues values;
  const std::map<std::string, Setting>* effective;
};

/// The values of each setting, where the choice of a strategy is a value of its own: `localizer.clusterer:
/// {dbscan: {eps: 1}}` and `localizer.clusterer.dbscan.eps: 1` both are `dbscan` and `1`. Settings that leave
/// alone what others set have the value they were run with, if what they ran has it.
[[nodiscard]] std::vector<SettingValues> comparable_values(const std::vector<SettingAsRun>& settings);

}  // namespace glocal
