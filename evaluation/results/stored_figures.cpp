#include "evaluation/results/stored_figures.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "evaluation/results/json_text.hpp"

namespace glocal {
namespace {

PoseError written_error(const nlohmann::ordered_json& line) {
  return {line.at("translation_error_m"), radians(line.at("rotation_error_deg").get<double>())};
}

}  // namespace

StoredRun read_figures(const std::filesystem::path& folder, const StepRange& range,
                       std::vector<TrialFigures>& figures) {
  std::map<std::size_t, TrialFigures> trials;
  const auto add_trial = [&](const nlohmann::ordered_json& line) {
    TrialFigures trial{outcome_of(line.at("outcome")), line.at("steps"), line.at("distance_m")};
    if (trial.outcome == Outcome::right) trial.error = written_error(line);
    trials[line.at("trial")] = std::move(trial);
  };
  const auto add_step = [&](const nlohmann::ordered_json& line) {
    TrialFigures& trial = trials[line.at("trial")];
    const std::size_t step = whole_number(line, "step");
    if (step >= range.from && step < range.to) trial.step_ms.push_back(stage_times(line));
    if (line.at("verdict") == to_string(VerdictKind::localized) && line.value("on_map", false) &&
        line.contains("translation_error_m"))
      trial.later_errors.push_back(written_error(line));
  };
  StoredRun run = read_results(folder, {add_trial, add_step});
  for (auto& [number, trial] : trials) figures.push_back(std::move(trial));
  return run;
}

}  // namespace glocal
