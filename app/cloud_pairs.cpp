#include "app/cloud_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "evaluation/statistics/statistics.hpp"

namespace glocal::app {
namespace {

std::string row_of(const std::string& name, const std::vector<const PairOutcome*>& outcomes) {
  std::size_t right = 0, right_and_match = 0, wrong = 0, wrong_and_match = 0;
  std::vector<double> times;
  for (const PairOutcome* outcome : outcomes) {
    const std::size_t match = outcome->registration.is_match ? 1 : 0;
    times.push_back(outcome->cpu_s);
    if (!outcome->is_right) continue;
    (*outcome->is_right ? right : wrong) += 1;
    (*outcome->is_right ? right_and_match : wrong_and_match) += match;
  }
  const auto matches = std::count_if(outcomes.begin(), outcomes.end(), [](const PairOutcome* outcome) {
    return outcome->registration.is_match;
  });
  return fmt::format("{:<12}{:>7}{:>9}{:>8}{:>16}{:>16}{:>15.3f}{:>9.3f}\n", name, outcomes.size(), matches,
                     right, fmt::format("{} of {}", right - right_and_match, right),
                     fmt::format("{} of {}", wrong_and_match, wrong), quantile(times, 0.5),
                     quantile(times, 1.0));
}

}  // namespace

bool is_right_pose(const Pose3& found, const Pose3& truth, const Points& source, double translation) {
  constexpr double rotation_deg = 5.0;
  const Vector3 middle = centroid(source);
  return (found * middle - truth * middle).norm() <= translation &&
         degrees(rotation_between(found, truth)) <= rotation_deg;
}

std::string table_of(const std::vector<PairOutcome>& outcomes) {
  std::vector<std::string> kinds;
  for (const PairOutcome& outcome : outcomes) {
    if (std::find(kinds.begin(), kinds.end(), outcome.pair.kind) == kinds.end())
      kinds.push_back(outcome.pair.kind);
  }
  std::string table =
      fmt::format("{:<12}{:>7}{:>9}{:>8}{:>16}{:>16}{:>15}{:>9}\n", "class", "pairs", "matches", "right",
                  "right refused", "wrong trusted", "median CPU s", "most");
  const auto add_row = [&](const std::string& name, auto belongs) {
    std::vector<const PairOutcome*> chosen;
    for (const PairOutcome& outcome : outcomes) {
      if (belongs(outcome)) chosen.push_back(&outcome);
    }
    table += row_of(name, chosen);
  };
  for (const std::string& kind : kinds)
    add_row(kind, [&](const PairOutcome& outcome) { return outcome.pair.kind == kind; });
  if (kinds.size() > 1) add_row("all", [](const PairOutcome&) { return true; });
  return table;
}

std::string json_line(const PairOutcome& outcome) {
  const Registration& r = outcome.registration;
  nlohmann::ordered_json json;
  if (!outcome.method.empty()) json["method"] = outcome.method;
  json["source"] = outcome.pair.source;
  json["target"] = outcome.pair.target;
  json["target_from_source"] = nullptr;
  if (r.target_from_source) {
    const Pose3& pose = *r.target_from_source;
    const Quaternion& q = pose.rotation;
    json["target_from_source"] = {{"translation", {pose.x, pose.y, pose.z}},
                                  {"quaternion", {q.x(), q.y(), q.z(), q.w()}}};
  }
  json["verdict"] = r.is_match ? "match" : "no_match";
  json["why"] = r.why;
  json["overlap"] = r.overlap;
  json["rmse_m"] = r.rmse;
  json["score"] = r.score;
  json["lead"] = r.lead;
  json["voxel_size_m"] = r.voxel_size;
  json["cpu_s"] = outcome.cpu_s;
  if (outcome.is_right) json["right"] = *outcome.is_right;
  return json.dump() + "\n";
}

}  // namespace glocal::app
