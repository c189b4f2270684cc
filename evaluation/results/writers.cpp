#include "evaluation/results/writers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "evaluation/results/pose_json.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

Json best_clusters(const StepResult& step, int most) {
  Json best = Json::array();
  for (std::size_t i = 0; i < std::min(step.clusters.size(), static_cast<std::size_t>(most)); ++i) {
    best.push_back({{"pose", to_json(step.clusters[i].map_from_robot, step.motion)},
                    {"size", step.clusters[i].members.size()},
                    {"r", step.ratings[i].r},
                    {"r_normalised", step.ratings[i].r_normalised}});
  }
  return best;
}

Json to_json(const MapPlace& place, Motion motion) {
  return {{"map", place.map}, {"pose", to_json(place.map_from_robot, motion)}};
}

void add_error(Json& json, const PoseError& error) {
  json["translation_error_m"] = error.translation_m;
  json["rotation_error_deg"] = degrees(error.rotation_rad);
}

/// Upper triangle, row by row: xx, xy, xt, yy, yt, tt.
Json to_json(const PoseCovariance& c) {
  return {c.xx, c.xy, c.xt, c.yy, c.yt, c.tt};
}

void add_estimate(Json& json, const PoseEstimate& estimate, const std::optional<double>& nees) {
  json["confidence"] = estimate.confidence;
  if (estimate.covariance) json["covariance"] = to_json(*estimate.covariance);
  if (nees) json["nees"] = *nees;
}

Json to_json(const Verification& v, const Certificate& certificate) {
  return {{"contact", certificate.contact},   {"at_most", certificate.at_most},
          {"distance_m", v.near.translation}, {"rotation_deg", degrees(v.near.rotation)},
          {"epsilon_m", certificate.epsilon}, {"delta_m", certificate.delta}};
}

Json to_json(const Verification& v, Motion motion) {
  constexpr std::size_t most_rivals = 5;
  Json rivals = Json::array();
  for (std::size_t i = 0; i < std::min(v.rivals.size(), most_rivals); ++i) {
    rivals.push_back({{"pose", to_json(v.rivals[i].map_from_robot, motion)},
                      {"contact", v.rivals[i].quality},
                      {"score", v.rivals[i].score}});
  }
  Json json = {{"refuted", v.is_refuted},
               {"score", v.score},
               {"margin", v.margin},
               {"points_tested", v.points_tested},
               {"rivals", std::move(rivals)}};
  if (v.certificate) json["certificate"] = to_json(v, *v.certificate);
  if (v.goes_on) json["goes_on"] = true;
  if (v.mirrored_contact) json["mirrored_contact"] = *v.mirrored_contact;
  return json;
}

Json to_json(const StageTimes& ms, bool is_verified) {
  Json json = {{"local_map", ms.local_map}, {"match", ms.match}, {"cluster", ms.cluster}, {"rate", ms.rate}};
  if (is_verified) json["verify"] = ms.verify;
  if (ms.after > 0.0) json["after"] = ms.after;
  return json;
}

Json to_json(const SetupCheck& setup) {
  Json json = {{"agreement", setup.agreement}, {"way_m", setup.way_m}};
  if (setup.mount_angle_deg) {
    json["mount_angle_deg"] = *setup.mount_angle_deg;
    json["mount_angle_sd_deg"] = setup.mount_angle_sd_deg;
  }
  if (setup.late_by) json["late_by"] = *setup.late_by;
  if (setup.range_bias_m) json["range_bias_m"] = *setup.range_bias_m;
  json["walls"] = setup.walls;
  json["stuck_share"] = setup.stuck_share;
  if (setup.fault) json["fault"] = to_string(*setup.fault);
  json["in_doubt"] = setup.is_in_doubt;
  return json;
}

/// One letter a hit.
std::string letters_of(const std::vector<HitKind>& hits) {
  std::string letters;
  for (const HitKind hit : hits) letters += "mnbu"[static_cast<std::size_t>(hit)];
  return letters;
}

std::string tum_line(double stamp, const Pose3& pose) {
  return fmt::format("{:.6f} {}\n", stamp, tum_text(pose));
}

}  // namespace

Json step_json(std::size_t trial, const StepRecord& record, int most_clusters) {
  const StepResult& step = record.result;
  const bool is_verified = step.verification.has_value();
  Json json = {{"trial", trial},
               {"step", step.step},
               {"stamp", step.stamp},
               {"stage_ms", to_json(step.stage_ms, is_verified)},
               {"stage_cpu_ms", to_json(step.stage_cpu_ms, is_verified)},
               {"local_map_points", step.local_map_points},
               {"contact_epsilon_m", step.contact_epsilon},
               {"omega_best", step.omega_best},
               {"score_best", step.score_best},
               {"omega_max", step.omega_max}};
  if (step.range_noise) json["range_noise_m"] = *step.range_noise;
  if (step.omega_place) json["omega_place"] = *step.omega_place;
  if (step.omega_scan) json["omega_scan"] = *step.omega_scan;
  if (!step.hit_kinds.empty()) json["hits"] = letters_of(step.hit_kinds);
  json["proposals"] = step.proposals;
  json["points_tested"] = step.points_tested;
  json["hypotheses"] = record.hypotheses;
  json["clusters"] = step.clusters.size();
  json["best"] = best_clusters(step, most_clusters);
  json["verdict"] = to_string(step.verdict.kind);
  json["why"] = step.verdict.why;
  if (!step.verdict.candidates.empty()) {
    Json candidates = Json::array();
    for (const Pose3& pose : step.verdict.candidates) candidates.push_back(to_json(pose, step.motion));
    json["candidates"] = std::move(candidates);
  }
  if (step.verification) json["verification"] = to_json(*step.verification, step.motion);
  if (step.setup) json["setup"] = to_json(*step.setup);
  for (const Evidence& e : step.verdict.evidence) json["evidence"][e.name] = e.value;
  json["local_from_robot"] = to_json(step.local_from_robot, step.motion);
  if (const auto estimate = step.estimate()) json["estimate"] = to_json(*estimate, step.motion);
  if (record.place) json["place"] = to_json(*record.place, step.motion);
  if (record.reference) {
    json["reference"] = to_json(*record.reference, step.motion);
    json["on_map"] = record.on_map;
  }
  if (record.error) add_error(json, *record.error);
  if (step.verdict.estimate) add_estimate(json, *step.verdict.estimate, record.nees);
  return json;
}

std::string step_line(std::size_t trial, const StepRecord& record, int most_clusters) {
  return step_json(trial, record, most_clusters).dump() + "\n";
}

Json start_json(const TrialRecord& trial) {
  Json start = {{"sample", trial.start_sample}, {"distance_m", trial.start_m}, {"stamp", trial.start_stamp}};
  if (trial.start_reference) start["reference"] = to_json(*trial.start_reference, trial.motion);
  if (!trial.start_map.empty()) start["map"] = trial.start_map;
  return start;
}

std::string trial_line(const TrialRecord& trial) {
  Json json = {{"trial", trial.trial},
               {"start", start_json(trial)},
               {"outcome", to_string(trial.outcome)},
               {"steps", trial.steps},
               {"distance_m", trial.distance_m}};
  if (trial.pose) json["pose"] = to_json(*trial.pose, trial.motion);
  if (trial.place) json["place"] = to_json(*trial.place, trial.motion);
  if (trial.error) add_error(json, *trial.error);
  if (trial.estimate) add_estimate(json, *trial.estimate, trial.nees);
  if (trial.verification && trial.verification->certificate)
    json["certificate"] = to_json(*trial.verification, *trial.verification->certificate);
  json["why"] = trial.why;
  return json.dump() + "\n";
}

std::string failed_trial_line(std::size_t trial, const Json& start, const std::string& why) {
  const Json json = {{"trial", trial}, {"start", start},    {"outcome", to_string(Outcome::failed)},
                     {"steps", 0},     {"distance_m", 0.0}, {"why", why}};
  return json.dump() + "\n";
}

Trajectories tum_trajectories(const TrialRecord& trial) {
  Trajectories result;
  for (const StepRecord& step : trial.records) {
    if (const auto estimate = step.result.estimate())
      result.estimate += tum_line(step.result.stamp, *estimate);
    if (const auto& declared = step.result.verdict.map_from_robot)
      result.localized += tum_line(step.result.stamp, *declared);
    if (step.reference) result.reference += tum_line(step.result.stamp, *step.reference);
  }
  return result;
}

}  // namespace glocal
