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
  add_poses(line);
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

void StepColumns::add_poses(const Json& line) {
  for (const char* pose : poses) {
    for (const char* coordinate : coordinates)
      columns_[pose][coordinate].push_back(line.contains(pose) ? number(line.at(pose).at(coordinate))
                                                               : Json(nullptr));
  }
  Json candidates = Json::array();
  if (line.contains("candidates")) {
    for (const Json& pose : line.at("candidates")) {
      for (const char* coordinate : coordinates) candidates.push_back(number(pose.at(coordinate)));
    }
  }
  columns_["candidates"].push_back(std::move(candidates));
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
    for (const char* coordinate : coordinates)
      best_[coordinate].push_back(number(cluster.at("pose").at(coordinate)));
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
