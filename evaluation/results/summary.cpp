#include "evaluation/results/summary.hpp"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/proportions.hpp"
#include "evaluation/statistics/statistics.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

Json spread(const std::vector<double>& values) {
  return {{"median", quantile(values, 0.5)}, {"p95", quantile(values, 0.95)}, {"max", quantile(values, 1.0)}};
}

Json median_and_p90(const std::vector<double>& values) {
  return {{"median", quantile(values, 0.5)}, {"p90", quantile(values, 0.9)}};
}

}  // namespace

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

TrialFigures figures_of(const TrialRecord& trial) {
  TrialFigures figures{trial.outcome, static_cast<double>(trial.steps), trial.distance_m};
  if (trial.outcome == Outcome::right) figures.error = *trial.error;
  if (trial.outcome == Outcome::declared)
    figures.declaration = {trial.start_m + trial.distance_m, trial.segment, *trial.pose,
                           *trial.odom_from_robot};
  for (const StepRecord& step : trial.records) {
    figures.step_ms.push_back(step.result.stage_ms);
    if (step.result.verdict.kind == VerdictKind::localized && step.on_map && step.error)
      figures.later_errors.push_back(*step.error);
  }
  return figures;
}

void Summary::add(const TrialFigures& trial) {
  ++count_;
  right_ += trial.outcome == Outcome::right ? 1 : 0;
  wrong_ += trial.outcome == Outcome::wrong ? 1 : 0;
  undecided_ += trial.outcome == Outcome::undecided ? 1 : 0;
  declared_ += trial.outcome == Outcome::declared ? 1 : 0;
  failed_ += trial.outcome == Outcome::failed ? 1 : 0;
  if (trial.outcome == Outcome::right) {
    steps_.push_back(trial.steps);
    distances_m_.push_back(trial.distance_m);
    translations_m_.push_back(trial.error.translation_m);
    rotations_deg_.push_back(degrees(trial.error.rotation_rad));
  }
  if (trial.declaration) declarations_.push_back(*trial.declaration);
  for (const StageTimes& ms : trial.step_ms) {
    ms_.local_map.push_back(ms.local_map);
    ms_.match.push_back(ms.match);
    ms_.cluster.push_back(ms.cluster);
    ms_.rate.push_back(ms.rate);
    if (ms.verify > 0.0) ms_.verify.push_back(ms.verify);
    ms_.total.push_back(ms.total());
    ms_.answer.push_back(ms.answer());
  }
  for (const PoseError& error : trial.later_errors) {
    later_translations_m_.push_back(error.translation_m);
    later_rotations_deg_.push_back(degrees(error.rotation_rad));
  }
}

Json Summary::figures() const {
  Json trials = {{"count", count_}, {"right", right_}, {"wrong", wrong_}, {"undecided", undecided_}};
  if (declared_ > 0) trials["declared_without_reference"] = declared_;
  // Stored trials do not tell where odometry was.
  if (!declarations_.empty()) {
    const Agreement agreement = agreement_of(declarations_);
    trials["agreement"] = {{"pairs", agreement.pairs}, {"disagree_at_m", agreement.disagree_at_m}};
  }
  if (failed_ > 0) trials["failed"] = failed_;
  Json stage_ms = {{"local_map", spread(ms_.local_map)},
                   {"match", spread(ms_.match)},
                   {"cluster", spread(ms_.cluster)},
                   {"rate", spread(ms_.rate)}};
  if (!ms_.verify.empty()) stage_ms["verify"] = spread(ms_.verify);
  Json answer_ms = spread(ms_.answer);
  answer_ms["p99"] = quantile(ms_.answer, 0.99);
  return {{"trials", std::move(trials)},
          {"steps", ms_.total.size()},
          {"success_rate", glocal::to_json(wilson(right_, count_))},
          {"false_rate", glocal::to_json(wilson(wrong_, count_))},
          {"steps_to_localize", median_and_p90(steps_)},
          {"distance_to_localize_m", median_and_p90(distances_m_)},
          {"translation_error_m", spread(translations_m_)},
          {"rotation_error_deg", spread(rotations_deg_)},
          {"after_declaration",
           {{"steps", later_translations_m_.size()},
            {"translation_error_m", spread(later_translations_m_)},
            {"rotation_error_deg", spread(later_rotations_deg_)}}},
          {"step_ms", spread(ms_.total)},
          {"answer_ms", std::move(answer_ms)},
          {"stage_ms", std::move(stage_ms)}};
}

Json Summary::to_json(const Json& run, bool complete) const {
  Json json = {{"name", run.at("name")}, {"seed", run.at("seed")}, {"complete", complete}};
  json.update(figures());
  for (const char* key : {"map", "peak_rss_mb", "others_load"}) {
    if (run.contains(key)) json[key] = run.at(key);
  }
  return json;
}

}  // namespace glocal
