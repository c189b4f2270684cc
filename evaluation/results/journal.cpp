#include "evaluation/results/journal.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/pose_json.hpp"
#include "glocal/error.hpp"

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
    step_ms.push_back({ms.local_map, ms.match, ms.cluster, ms.rate, ms.verify});
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
  for (const Json& ms : json.at("step_ms"))
    figures.step_ms.push_back({ms.at(0), ms.at(1), ms.at(2), ms.at(3), ms.at(4)});
  for (const Json& error : json.at("later_errors")) figures.later_errors.push_back(error_of(error));
  if (json.contains("declaration")) figures.declaration = declaration_of(json.at("declaration"));
  return figures;
}

[[noreturn]] void refuse_entry(const std::filesystem::path& file, const std::string& why) {
  throw RunError(fmt::format("{}:1: {}", file.string(), why));
}

void check_files(const JournalEntry& entry, const std::filesystem::path& folder,
                 const std::filesystem::path& file) {
  for (const auto& [name, sum] : entry.files) {
    if (why_unreadable(folder / name)) refuse_entry(file, fmt::format("the trial's {} is missing", name));
    if (checksum(content_of(folder / name)) != sum)
      refuse_entry(file, fmt::format("the trial's {} is damaged: its checksum is another one", name));
  }
}

}  // namespace

Json to_json(const JournalEntry& entry) {
  return {{"trial", entry.trial},
          {"figures", to_json(entry.figures)},
          {"trial_line", entry.trial_line},
          {"step_lines", entry.step_lines},
          {"files", entry.files}};
}

JournalEntry entry_of(const Json& json) {
  return {whole_number(json, "trial"), figures_of(json.at("figures")), json.at("trial_line"),
          json.at("step_lines"), json.at("files")};
}

std::string checksum(std::string_view bytes) {
  return fmt::format("{:08x}", libdeflate_crc32(0, bytes.data(), bytes.size()));
}

std::optional<std::string_view> checked_content(std::string_view text) {
  const std::string_view content = text.substr(std::min(text.size(), std::size_t{9}));
  if (content.empty() || !text.starts_with(checksum(content) + " ")) return std::nullopt;
  return content;
}

std::filesystem::path entry_name(std::size_t trial) {
  return std::filesystem::path(journal_folder) / fmt::format("trial_{:04}.json", trial);
}

void write_entry(OutputFolder& folder, const JournalEntry& entry) {
  const std::string text = to_json(entry).dump() + "\n";
  folder.write_for_good(entry_name(entry.trial), checksum(text) + " " + text);
}

std::optional<JournalEntry> read_entry(const std::filesystem::path& folder, std::size_t trial) {
  const std::filesystem::path file = folder / entry_name(trial);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  const std::string line = content_of(file);
  const auto text = checked_content(line);
  if (!text) refuse_entry(file, "the entry is damaged: its checksum is another one");
  JournalEntry entry;
  try {
    entry = entry_of(parse_json(std::string(*text)));
  } catch (const std::exception&) {
    refuse_entry(file, "the entry is not as glocal run leaves it");
  }
  if (entry.trial != trial) refuse_entry(file, fmt::format("the entry is of trial {}", entry.trial));
  check_files(entry, folder, file);
  return entry;
}

}  // namespace glocal
