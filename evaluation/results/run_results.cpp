#include "evaluation/results/run_results.hpp"

#include <fmt/format.h>

#include "evaluation/results/pcd.hpp"
#include "evaluation/results/valid_text.hpp"
#include "evaluation/results/writers.hpp"
#include "glocal/error.hpp"

namespace glocal {

RunResults::RunResults(OutputFolder& folder, const OutputConfig& config, std::size_t trials,
                       const std::function<void(const std::string&)>& warn)
    : folder_(folder), config_(config), trials_(trials) {
  for (std::size_t trial = 0; trial < trials; ++trial) take_up(trial, warn);
}

void RunResults::take_up(std::size_t trial, const std::function<void(const std::string&)>& warn) {
  try {
    if (read_entry(folder_.unfinished(), trial)) return;
  } catch (const RunError& damage) {
    warn(fmt::format("{}; trial {} runs again", damage.what(), trial));
    std::error_code ignored;
    std::filesystem::remove(folder_.unfinished() / entry_name(trial), ignored);
  }
  to_run_.push_back(trial);
}

void RunResults::step(std::size_t trial, const StepRecord& record, const Scan& scan,
                      const Localizer& localizer) {
  if (!keeps_map(trial)) return;
  const auto name = [&](const char* what, const std::string& extension) {
    return fmt::format("maps/trial_{:04}/{}_{:04}.{}", trial, what, record.result.step, extension);
  };
  MapFiles files = {{name("step", "pcd"), pcd(localizer.local_map().points)},
                    {name("scan", "pcd"), pcd(scan.hits)}};
  for (MapFile& file : localizer.local_map_files())
    files.emplace_back(name("step", valid_utf8(file.extension)), std::move(file.content));
  const std::lock_guard lock(mutex_);
  for (auto& file : files) maps_[trial].push_back(std::move(file));
}

void RunResults::finish(const TrialRecord& trial) {
  JournalEntry entry{trial.trial, figures_of(trial), trial_line(trial), ""};
  const auto write = [&](const std::string& name, const std::string& content) {
    folder_.write(name, content);
    entry.files[name] = checksum(content);
  };
  if (config_.steps) {
    for (const StepRecord& record : trial.records)
      entry.step_lines += step_line(trial.trial, record, config_.clusters);
  }
  const Trajectories trajectories = tum_trajectories(trial);
  write(fmt::format("trajectories/trial_{:04}_estimate.tum", trial.trial), trajectories.estimate);
  write(fmt::format("trajectories/trial_{:04}_localized.tum", trial.trial), trajectories.localized);
  if (!trajectories.reference.empty())
    write(fmt::format("trajectories/trial_{:04}_reference.tum", trial.trial), trajectories.reference);
  for (const auto& [name, content] : take_maps(trial.trial)) write(name, content);
  write_entry(folder_, entry);
  folder_.keep_unfinished();
}

Summary RunResults::put_together() {
  Summary summary;
  folder_.write("trials.jsonl", "");
  if (config_.steps) folder_.write("steps.jsonl", "");
  for (std::size_t trial = 0; trial < trials_; ++trial) {
    const auto entry = read_entry(folder_.unfinished(), trial);
    if (!entry) continue;
    folder_.append("trials.jsonl", entry->trial_line);
    if (config_.steps) folder_.append("steps.jsonl", entry->step_lines);
    summary.add(entry->figures);
  }
  return summary;
}

bool RunResults::keeps_map(std::size_t trial) const {
  return config_.maps == "all" || (config_.maps == "first_trial" && trial == 0);
}

RunResults::MapFiles RunResults::take_maps(std::size_t trial) {
  const std::lock_guard lock(mutex_);
  const auto node = maps_.extract(trial);
  return node.empty() ? MapFiles{} : std::move(node.mapped());
}

}  // namespace glocal
