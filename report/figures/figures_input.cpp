#include "report/figures/figures_input.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/map_files.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/results/results_folder.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void check_number(const Json& json, const char* key) {
  static_cast<void>(json.at(key).get<double>());
}

void check_pose(const Json& json, const char* key) {
  for (const char* axis : {"x", "y", "theta"}) check_number(json.at(key), axis);
}

/// Throws a std::exception if figures.py could not read the step.
void check_step(const Json& step) {
  check_number(step.at("stage_ms"), "match");
  for (const char* key : {"omega_best", "score_best", "omega_max", "hypotheses", "clusters"})
    check_number(step, key);
  for (const char* key : {"omega_place", "translation_error_m", "rotation_error_deg"}) {
    if (step.contains(key)) check_number(step, key);
  }
  static_cast<void>(step.at("verdict").get<std::string>());
  check_pose(step, "local_from_robot");
  for (const char* key : {"estimate", "reference"}) {
    if (step.contains(key)) check_pose(step, key);
  }
  for (const Json& cluster : step.at("best")) {
    check_number(cluster, "r");
    check_pose(cluster, "pose");
  }
}

/// That the run has steps of the trial, and figures.py can read them.
void check_files(const fs::path& folder, std::size_t trial) {
  std::optional<std::size_t> steps;
  std::size_t last = 0;
  const auto note_trial = [&](const Json& line) {
    last = line.at("trial");
    if (last == trial) steps = line.at("steps").get<std::size_t>();
  };
  const auto look_at_step = [&](const Json& line) {
    if (line.at("trial") == trial) check_step(line);
  };
  require_steps(read_results(folder, {note_trial, look_at_step}));
  const fs::path file = folder / "trials.jsonl";
  if (!steps)
    throw ConfigError(file,
                      fmt::format("has no trial {}; choose one from 0 to {} with --trial", trial, last));
  if (*steps == 0)
    throw ConfigError(file, fmt::format("trial {} has no steps; choose another with --trial", trial));
}

void check_point_clouds(const fs::path& folder, std::size_t trial, FaultCollector& faults) {
  std::vector<fs::path> files;
  std::error_code unreachable;
  if (const fs::path global = folder / map_points_file; fs::exists(global, unreachable))
    files.push_back(global);
  const fs::path local = folder / fmt::format("maps/trial_{:04}", trial);
  for (const auto& entry : fs::directory_iterator(local, unreachable)) {
    if (entry.path().extension() == ".pcd") files.push_back(entry.path());
  }
  for (const fs::path& file : files) {
    faults.collect([&] { static_cast<void>(read_map_pcd(file)); });
  }
}

}  // namespace

void check_figures_input(const fs::path& folder, std::size_t trial, FaultCollector& faults) {
  faults.collect([&] { check_files(folder, trial); });
  check_point_clouds(folder, trial, faults);
}

}  // namespace glocal::app
