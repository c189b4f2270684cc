#include "evaluation/results/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path name_of(std::size_t trial) {
  return std::filesystem::path(journal_folder) / fmt::format("trial_{:04}.json", trial);
}

Json to_json(const PoseError& error) {
  return {error.translation_m, error.rotation_rad};
}

PoseError error_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}

Json to_json(const TrialFigures& figures) {
  Json step_ms = Json::array();
  for (const StageTimes& ms : figures.step_ms)
    step_ms.push_back({ms.local_map, ms.match, ms.cluster, ms.rate});
  Json later_errors = Json::array();
  for (const PoseError& error : figures.later_errors) later_errors.push_back(to_json(error));
  return {{"outcome", to_string(figures.outcome)}, {"steps", figures.steps},
          {"distance_m", figures.distance_m},      {"error", to_json(figures.error)},
          {"step_ms", std::move(step_ms)},         {"later_errors", std::move(later_errors)}};
}

TrialFigures figures_of(const Json& json) {
  TrialFigures figures;
  figures.outcome = outcome_of(json.at("outcome"));
  figures.steps = json.at("steps");
  figures.distance_m = json.at("distance_m");
  figures.error = error_of(json.at("error"));
  for (const Json& ms : json.at("step_ms"))
    figures.step_ms.push_back({ms.at(0), ms.at(1), ms.at(2), ms.at(3)});
  for (const Json& error : json.at("later_errors")) figures.later_errors.push_back(error_of(error));
  return figures;
}

bool are_whole(const std::map<std::string, std::uintmax_t>& files, const std::filesystem::path& folder) {
  std::error_code error;
  return std::all_of(files.begin(), files.end(), [&](const auto& file) {
    return std::filesystem::file_size(folder / file.first, error) == file.second;
  });
}

}  // namespace

void write_entry(OutputFolder& folder, const JournalEntry& entry) {
  const Json json = {{"trial", entry.trial},
                     {"figures", to_json(entry.figures)},
                     {"trial_line", entry.trial_line},
                     {"step_lines", entry.step_lines},
                     {"files", entry.files}};
  folder.write(name_of(entry.trial), json.dump() + "\n");
}

std::optional<JournalEntry> read_entry(const std::filesystem::path& folder, std::size_t trial) try {
  std::ifstream in(folder / name_of(trial));
  if (!in) return std::nullopt;
  const Json json = Json::parse(in);
  JournalEntry entry{json.at("trial"), figures_of(json.at("figures")), json.at("trial_line"),
                     json.at("step_lines"), json.at("files")};
  return entry.trial == trial && are_whole(entry.files, folder) ? std::optional(std::move(entry))
                                                                : std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;  // no JSON, or not of this form
}

}  // namespace glocal
