#include "evaluation/results/journal_entry.hpp"

#include <nlohmann/json.hpp>

#include "evaluation/results/json_text.hpp"
#include "evaluation/results/pose_json.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const PoseError& error) {
  return {error.translation_m, error.rotation_rad};
}

PoseError error_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}

Json to_json(const Declaration& declaration) {
  return {{"at_m", declaration.at_m},
          {"segment", declaration.segment},
          {"map_from_robot", to_json(declaration.map_from_robot, Motion::free)},
          {"odom_from_robot", to_json(declaration.odom_from_robot, Motion::free)}};
}

Declaration declaration_of(const Json& json) {
  return {json.at("at_m"), static_cast<int>(whole_number(json, "segment")),
          pose_of(json.at("map_from_robot")), pose_of(json.at("odom_from_robot"))};
}

Json to_json(const TrialFigures& figures) {
  Json step_ms = Json::array();
  for (const StageTimes& ms : figures.step_ms)
    step_ms.push_back({ms.local_map, ms.match, ms.cluster, ms.rate, ms.verify, ms.after});
  Json later_errors = Json::array();
  for (const PoseError& error : figures.later_errors) later_errors.push_back(to_json(error));
  Json json = {{"outcome", to_string(figures.outcome)}, {"steps", figures.steps},
               {"distance_m", figures.distance_m},      {"error", to_json(figures.error)},
               {"step_ms", std::move(step_ms)},         {"later_errors", std::move(later_errors)}};
  if (figures.declaration) json["declaration"] = to_json(*figures.declaration);
  return json;
}

TrialFigures figures_of(const Json& json) {
  TrialFigures figures;
  figures.outcome = outcome_of(json.at("outcome"));
  figures.steps = json.at("steps");
  figures.distance_m = json.at("distance_m");
  figures.error = error_of(json.at("error"));
  for (const Json& ms : json.at("step_ms")) {
    // No search went on where the sixth is missing.
    const double after = ms.size() > 5 ? ms.at(5).get<double>() : 0.0;
    figures.step_ms.push_back({ms.at(0), ms.at(1), ms.at(2), ms.at(3), ms.at(4), after});
  }
  for (const Json& error : json.at("later_errors")) figures.later_errors.push_back(error_of(error));
  if (json.contains("declaration")) figures.declaration = declaration_of(json.at("declaration"));
  return figures;
}

}  // namespace

Json to_json(const JournalEntry& entry) {
  return {{"trial", entry.trial},
          {"figures", to_json(entry.figures)},
          {"trial_line", entry.trial_line},
          {"step_lines", entry.step_lines}};
}

JournalEntry entry_of(const Json& json) {
  return {whole_number(json, "trial"), figures_of(json.at("figures")), json.at("trial_line"),
          json.at("step_lines")};
}

}  // namespace glocal
