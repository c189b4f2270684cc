#include "evaluation/running/trials.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "evaluation/results/json_text.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

/// Notes the trial's first declaration.
void declare(TrialRecord& trial, const StepRecord& record, const EvaluationConfig& limits) {
  trial.pose = record.result.verdict.map_from_robot;
  trial.place = record.place;
  if (record.reference) trial.error = pose_error(*trial.pose, *record.reference);
  trial.outcome = judge(trial.error, limits);
  trial.estimate = record.result.verdict.estimate;
  trial.nees = record.nees;
  trial.verification = record.result.verification;
}

/// Texts of plugins may be in any encoding; what is written is UTF-8.
void make_valid_utf8(Verdict& verdict) {
  verdict.why = valid_utf8(verdict.why);
  for (Evidence& evidence : verdict.evidence) evidence.name = valid_utf8(evidence.name);
}

/// Does what a strategy may fail in; false if one did, with which the trial has failed.
template <class Work>
bool done_or_failed(TrialRecord& trial, Work work) {
  try {
    work();
    return true;
  } catch (const StrategyError& error) {
    trial.why = valid_utf8(error.what());
    trial.outcome = Outcome::failed;
    return false;
  }
}

}  // namespace

std::size_t step_limit(const TrialsConfig& config) {
  if (config.whole || config.max_steps == 0) return std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(config.max_steps);
}

std::size_t steps_left(const Drive& drive, const TrialsConfig& config, std::size_t start_sample) {
  const auto first = drive.samples.begin() + static_cast<std::ptrdiff_t>(start_sample);
  const auto end = std::find_if(first, drive.samples.end(),
                                [&](const Sample& sample) { return sample.segment != first->segment; });
  return std::min(step_limit(config), static_cast<std::size_t>(end - first));
}

StepResult waited_for(Localizer& localizer, StepResult result) {
  while (result.goes_on()) result = localizer.go_on();
  return result;
}

PoseError pose_error(const Pose3& estimate, const Pose3& reference) {
  return {distance(estimate, reference), rotation_between(estimate, reference)};
}

bool is_on_map(const Pose3& reference, const GlobalMap& map) {
  const Pose3 place = map.relative(reference);
  return map.grid().cells.empty() || map.grid().at(place.x, place.y) != Cell::unknown;
}

Outcome judge(const std::optional<PoseError>& error, const EvaluationConfig& limits) {
  if (!error) return Outcome::declared;
  const bool right = error->translation_m <= limits.max_translation_error &&
                     degrees(error->rotation_rad) <= limits.max_rotation_error_deg;
  return right ? Outcome::right : Outcome::wrong;
}

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::right:
      return "right";
    case Outcome::wrong:
      return "wrong";
    case Outcome::undecided:
      return "undecided";
    case Outcome::declared:
      return "declared";
    case Outcome::failed:
      return "failed";
  }
  return "";
}

Outcome outcome_of(const std::string& name) {
  using enum Outcome;
  for (const Outcome outcome : {right, wrong, undecided, declared, failed}) {
    if (name == to_string(outcome)) return outcome;
  }
  throw std::invalid_argument("there is no outcome '" + name + "'");
}

StepRecord record_of(StepResult result, const Sample& sample, const GlobalMap& map) {
  StepRecord record;
  record.hypotheses = result.hypotheses.size();
  record.result = std::move(result);
  record.result.hypotheses = {};
  record.reference = sample.map_from_robot;
  if (const auto estimate = record.result.estimate(); estimate && !map.parts().empty())
    record.place = map.place_of(*estimate);
  if (record.reference) {
    record.on_map = is_on_map(*record.reference, map);
    if (const auto estimate = record.result.estimate())
      record.error = pose_error(*estimate, *record.reference);
    const auto& estimate = record.result.verdict.estimate;
    if (estimate && estimate->covariance)
      record.nees = normalised_error_squared(seen_from_above(estimate->map_from_robot),
                                             seen_from_above(*record.reference), *estimate->covariance);
  }
  return record;
}

TrialRecord begun_trial(const Drive& drive, Motion motion, std::size_t trial, std::size_t start_sample) {
  const Sample& start = drive.samples[start_sample];
  TrialRecord record;
  record.trial = trial;
  record.start_sample = start_sample;
  record.segment = start.segment;
  record.start_m = drive.path_m[start_sample];
  record.start_stamp = start.observation.stamp;
  record.motion = motion;
  record.start_reference = start.map_from_robot;
  record.start_map = start.map;
  return record;
}

std::optional<TrialRecord> run_trial(Localizer& localizer, const Drive& drive, const GlobalMap& map,
                                     const Experiment& experiment, std::size_t trial,
                                     std::size_t start_sample, const TrialCallbacks& callbacks) {
  TrialRecord record = begun_trial(drive, experiment.localizer.motion, trial, start_sample);
  bool going_on = done_or_failed(record, [&] { localizer.reset(start_number(experiment.trials, trial)); });
  const std::size_t end_sample = start_sample + steps_left(drive, experiment.trials, start_sample);
  for (std::size_t i = start_sample; going_on && i < end_sample; ++i) {
    const Sample& sample = drive.samples[i];
    if (record.pose && !experiment.trials.whole) break;
    if (callbacks.stop && callbacks.stop()) return std::nullopt;

    StepResult result;
    going_on =
        done_or_failed(record, [&] { result = waited_for(localizer, localizer.step(sample.observation)); });
    if (!going_on) break;
    make_valid_utf8(result.verdict);
    record.records.push_back(record_of(std::move(result), sample, map));
    const StepRecord& step = record.records.back();
    if (callbacks.step) callbacks.step(step, localizer);
    if (record.pose) continue;
    record.steps = i - start_sample + 1;
    record.distance_m = drive.path_m[i] - record.start_m;
    record.why = step.result.verdict.why;
    if (step.result.verdict.kind != VerdictKind::localized) continue;
    record.odom_from_robot = sample.observation.odom_from_robot;
    declare(record, step, experiment.evaluation);
  }
  return record;
}

}  // namespace glocal
