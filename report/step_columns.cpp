#include "report/step_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "report/numbers.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array stages = {"local_map", "match", "cluster", "rate"};
constexpr std::array numbers = {"local_map_points", "omega_best",    "score_best", "omega_max",
                                "proposals",        "points_tested", "hypotheses", "clusters"};
constexpr std::array optional_numbers = {"omega_place", "translation_error_m", "rotation_error_deg",
                                         "confidence"};
constexpr std::array poses = {"estimate", "reference", "local_from_robot"};
constexpr std::array coordinates = {"x", "y", "theta"};
constexpr std::array coordinates_in_space = {"z", "qx", "qy", "qz", "qw"};
constexpr std::array cluster_numbers = {"size", "r", "r_normalised"};

/// A writer has only null for infinity and for what is no number.
Json number(const Json& value) {
  if (value.is_null()) return nullptr;
  if (value.is_number_integer()) return value;
  return short_number(value.get<double>());
}

Json number_or_null(const Json& line, const char* key) {
  return line.contains(key) ? number(line.at(key)) : Json(nullptr);
}

bool is_in_space(const Json& line) {
  return line.contains("local_from_robot") && line.at("local_from_robot").contains("z");
}

Json empty_columns() {
  Json columns;
  const auto add = [&](const auto& keys) {
    for (const char* key : keys) columns[key] = Json::array();
  };
  add(std::array{"step", "stamp"});
  for (const char* stage : stages) columns[fmt::format("{}_ms", stage)] = Json::array();
  add(numbers);
  add(optional_numbers);
  add(std::array{"verdict", "why", "on_map"});
  for (const char* pose : poses) {
    for (const char* coordinate : coordinates) columns[pose][coordinate] = Json::array();
  }
  columns["candidates"] = Json::array();
  return columns;
}

Json empty_best() {
  Json best = {{"first", {0}}};
  for (const char* coordinate : coordinates) best[coordinate] = Json::array();
  for (const char* key : cluster_numbers) best[key] = Json::array();
  return best;
}

}  // namespace

StepColumns::StepColumns(std::size_t clusters)
    : clusters_(clusters), columns_(empty_columns()), best_(empty_best()) {}

void StepColumns::add(const Json& line) {
  const auto step = line.at("step").get<std::size_t>();
  if (step != steps_)
    throw std::invalid_argument(fmt::format("step {} of trial {} is here, where step {} belongs", step,
                                            line.at("trial").get<std::size_t>(), steps_));
  columns_["step"].push_back(step);
  columns_["stamp"].push_back(line.at("stamp").get<double>());
  add_numbers(line);
  columns_["verdict"].push_back(line.at("verdict").get<std::string>());
  columns_["on_map"].push_back(line.contains("on_map") ? Json(line.at("on_map").get<bool>()) : Json(nullptr));
  add_sentence(line.at("why"));
  if (steps_ == 0 && is_in_space(line)) go_to_space();
  add_poses(line);
  add_verification(line);
  add_evidence(line);
  add_clusters(line);
  ++steps_;
}

void StepColumns::add_numbers(const Json& line) {
  for (const char* stage : stages)
    columns_[fmt::format("{}_ms", stage)].push_back(number(line.at("stage_ms").at(stage)));
  for (const char* key : numbers) columns_[key].push_back(number(line.at(key)));
  for (const char* key : optional_numbers) columns_[key].push_back(number_or_null(line, key));
}

void StepColumns::add_sentence(const std::string& why) {
  const auto [known, is_new] = sentence_numbers_.emplace(why, sentences_.size());
  if (is_new) sentences_.push_back(why);
  columns_["why"].push_back(known->second);
}

/// Poses have a height and a rotation, too.
void StepColumns::go_to_space() {
  is_in_space_ = true;
  for (const char* coordinate : coordinates_in_space) {
    for (const char* pose : poses) columns_[pose][coordinate] = Json::array();
    best_[coordinate] = Json::array();
  }
  columns_["candidates_in_space"] = Json::array();
}

void StepColumns::add_poses(const Json& line) {
  for (const char* pose : poses) {
    for (auto& [coordinate, column] : columns_[pose].items())
      column.push_back(line.contains(pose) ? number(line.at(pose).at(coordinate)) : Json(nullptr));
  }
  const auto add_candidates = [&](const char* key, const auto& keys) {
    Json candidates = Json::array();
    for (const Json& pose : line.value("candidates", Json::array())) {
      for (const char* coordinate : keys) candidates.push_back(number(pose.at(coordinate)));
    }
    columns_[key].push_back(std::move(candidates));
  };
  add_candidates("candidates", coordinates);
  if (is_in_space_) add_candidates("candidates_in_space", coordinates_in_space);
}

void StepColumns::add_verification(const Json& line) {
  if (!line.contains("verification")) return;
  Json verification = line.at("verification");
  verification["step"] = steps_;
  columns_["verifications"].push_back(std::move(verification));
}

void StepColumns::add_evidence(const Json& line) {
  if (line.contains("evidence")) {
    for (const auto& [name, value] : line.at("evidence").items()) {
      if (!evidence_.contains(name)) evidence_[name] = std::vector<std::nullptr_t>(steps_);
      evidence_[name].push_back(number(value));
    }
  }
  for (auto& [name, column] : evidence_.items()) {
    if (column.size() == steps_) column.push_back(nullptr);
  }
}

void StepColumns::add_clusters(const Json& line) {
  const Json& best = line.at("best");
  const std::size_t n = std::min(best.size(), clusters_);
  for (std::size_t i = 0; i < n; ++i) {
    const Json& cluster = best.at(i);
    const auto add_pose = [&](const auto& keys) {
      for (const char* key : keys) best_[key].push_back(number(cluster.at("pose").at(key)));
    };
    add_pose(coordinates);
    if (is_in_space_) add_pose(coordinates_in_space);
    for (const char* key : cluster_numbers) best_[key].push_back(number(cluster.at(key)));
  }
  best_["first"].push_back(best_["x"].size());
}

Json StepColumns::to_json() const {
  Json json = columns_;
  json["evidence"] = evidence_;
  json["best"] = best_;
  json["sentences"] = sentences_;
  return json;
}

}  // namespace glocal
