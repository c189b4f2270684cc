#include "evaluation/results/trial_output.hpp"

#include <fmt/format.h>

#include "evaluation/results/json_text.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/results/writers.hpp"

namespace glocal {

void TrialCollector::step(std::size_t trial, const StepRecord& record, const Scan& scan,
                          const Localizer& localizer) {
  if (!keeps_map(trial)) return;
  const auto name = [&](const char* what, const std::string& extension) {
    return fmt::format("maps/trial_{:04}/{}_{:04}.{}", trial, what, record.result.step, extension);
  };
  NamedContents files = {{name("step", "pcd"), pcd(localizer.local_map().points)},
                         {name("scan", "pcd"), pcd(scan.hits)}};
  for (MapFile& file : localizer.local_map_files())
    files.emplace_back(name("step", valid_utf8(file.extension)), std::move(file.content));
  const std::lock_guard lock(mutex_);
  for (auto& file : files) maps_[trial].push_back(std::move(file));
}

TrialOutput TrialCollector::finish(const TrialRecord& trial) {
  TrialOutput output{{trial.trial, figures_of(trial), trial_line(trial), ""}, {}};
  if (config_.steps) {
    for (const StepRecord& record : trial.records)
      output.entry.step_lines += step_line(trial.trial, record, config_.clusters);
  }
  if (config_.trajectories) {
    const auto add = [&](const char* what, std::string content) {
      output.files.emplace_back(fmt::format("trajectories/trial_{:04}_{}.tum", trial.trial, what),
                                std::move(content));
    };
    Trajectories trajectories = tum_trajectories(trial);
    add("estimate", std::move(trajectories.estimate));
    add("localized", std::move(trajectories.localized));
    if (!trajectories.reference.empty()) add("reference", std::move(trajectories.reference));
  }
  const std::lock_guard lock(mutex_);
  if (const auto maps = maps_.extract(trial.trial)) {
    for (auto& file : maps.mapped()) output.files.push_back(std::move(file));
  }
  return output;
}

bool TrialCollector::keeps_map(std::size_t trial) const {
  return config_.maps == "all" || (config_.maps == "first_trial" && trial == 0);
}

}  // namespace glocal
