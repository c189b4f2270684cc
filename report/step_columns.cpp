#include "report/step_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "evaluation/results/results_folder.hpp"
#include "report/numbers.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array numbers = {"local_map_points", "omega_best", "score_best", "omega_max",
                                "proposals",        "hypotheses", "clusters"};
constexpr std::array optional_numbers = {"omega_place", "translation_error_m", "rotation_error_deg",
                                         "confidence",  "contact_epsilon_m",   "range_noise_m"};
constexpr std::array poses = {"estimate", "reference", "local_from_robot"};
constexpr std::array coordinates = {"x", "y", "theta"};
constexpr std::array coordinates_in_space = {"z", "qx", "qy", "qz", "qw"};
constexpr std::array cluster_numbers = {"size", "r", "r_normalised"};

constexpr int digits = 5;

/// A writer has only null for infinity and for what is no number.
Json number(const Json& value) {
  if (value.is_null()) return nullptr;
  if (value.is_number_integer()) return value;
  return short_number(value.get<double>(), digits);
}

Json number_or_null(const Json& line, const char* key) {
  return line.contains(key) ? number(line.at(key)) : Json(nullptr);
}

double number_of_cluster(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

/// One number of a pose: m, rad, or of a unit quaternion.
Json pose_number(std::string_view name, double value) {
  if (name == "x" || name == "y" || name == "z") return rounded(value, 1e3);
  return rounded(value, name == "theta" ? 1e4 : 1e5);
}

bool is_in_space(const Json& line) {
  return line.contains("local_from_robot") && line.at("local_from_robot").contains("z");
}

Json empty_columns() {
  Json columns;
  const auto add = [&](const auto& keys) {
    for (const char* key : keys) columns[key] = Json::array();
  };
  add(std::array{"step", "step_ms", "match_ms"});
  add(numbers);
  add(optional_numbers);
  add(std::array{"verdict", "why", "hits"});
  for (const char* pose : poses) {
    for (const char* coordinate : coordinates) columns[pose][coordinate] = Json::array();
  }
  columns["candidates"] = Json::array();
  return columns;
}

}  // namespace

StepColumns::StepColumns(std::size_t clusters) : clusters_(clusters), columns_(empty_columns()) {}

void StepColumns::add(const Json& line) {
  const auto step = line.at("step").get<std::size_t>();
  if (step != steps_)
    throw std::invalid_argument(fmt::format("step {} of trial {} is here, where step {} belongs", step,
                                            line.at("trial").get<std::size_t>(), steps_));
  columns_["step"].push_back(step);
  add_numbers(line);
  columns_["verdict"].push_back(line.at("verdict").get<std::string>());
  add_sentence(line.at("why"));
  columns_["hits"].push_back(line.value("hits", ""));
  if (steps_ == 0 && is_in_space(line)) go_to_space();
  add_poses(line);
  add_verification(line);
  add_evidence(line);
  add_clusters(line);
  ++steps_;
}

void StepColumns::add_numbers(const Json& line) {
  const StageTimes times = stage_times(line);
  step_ms_.push_back(static_cast<float>(times.total()));
  columns_["step_ms"].push_back(short_number(times.total(), digits));
  columns_["match_ms"].push_back(short_number(times.match, digits));
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
  }
  columns_["candidates_in_space"] = Json::array();
}

void StepColumns::add_poses(const Json& line) {
  for (const char* pose : poses) {
    for (auto& [name, column] : columns_[pose].items())
      column.push_back(line.contains(pose) ? pose_number(name, line.at(pose).at(name).get<double>())
                                           : Json(nullptr));
  }
  const auto add_candidates = [&](const char* key, const auto& keys) {
    Json candidates = Json::array();
    for (const Json& pose : line.value("candidates", Json::array())) {
      for (const char* name : keys) candidates.push_back(pose_number(name, pose.at(name).get<double>()));
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
    const auto add = [&](const Json& from, const auto& keys) {
      for (const char* key : keys) best_[key].push_back(number_of_cluster(from.at(key)));
    };
    add(cluster.at("pose"), coordinates);
    if (is_in_space_) add(cluster.at("pose"), coordinates_in_space);
    add(cluster, cluster_numbers);
  }
  first_best_.push_back(first_best_.back() + n);
}

Json StepColumns::best_to_json() const {
  Json json = {{"first", first_best_}};
  const auto add = [&](const auto& keys, const auto& shown) {
    for (const char* key : keys) {
      json[key] = Json::array();
      const auto column = best_.find(key);
      if (column == best_.end()) continue;
      for (const double value : column->second) json[key].push_back(shown(key, value));
    }
  };
  add(coordinates, pose_number);
  add(cluster_numbers, [](const char* /*key*/, double value) {
    return std::isnan(value) ? Json(nullptr) : short_number(value, digits);
  });
  if (is_in_space_) add(coordinates_in_space, pose_number);
  return json;
}

Json StepColumns::to_json() const {
  Json json = columns_;
  json["evidence"] = evidence_;
  json["best"] = best_to_json();
  json["sentences"] = sentences_;
  return json;
}

}  // namespace glocal
