// Runs localization trials along a drive and judges their answers.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/running/drive.hpp"
#include "glocal/experiment.hpp"
#include "glocal/localizer.hpp"
#include "glocal/outcome.hpp"
#include "glocal/step_result.hpp"

namespace glocal {

struct PoseError {
  double translation_m = 0.0;
  double rotation_rad = 0.0;
};
[[nodiscard]] PoseError pose_error(const Pose3& estimate, const Pose3& reference);

/// Whether a pose lies where the map's grid is not unknown; always so on a map of points alone.
[[nodiscard]] bool is_on_map(const Pose3& reference, const GlobalMap& map);

/// What a declared pose of this error is; one without reference is `declared`.
[[nodiscard]] Outcome judge(const std::optional<PoseError>& error, const EvaluationConfig& limits);

/// A step with what the evaluation knows about it.
struct StepRecord {
  StepResult result;  ///< Without its hypotheses, which can be tens of thousands.
  std::size_t hypotheses = 0;
  std::optional<Pose3> reference;
  std::optional<PoseError> error;  ///< Of the estimate, declared or not.
  std::optional<double> nees;      ///< Normalised error squared of what the verdict rule believes.
  bool on_map = false;             ///< The reference is_on_map().
  std::optional<MapPlace> place;   ///< Of the estimate, where there are several maps.
};

/// What is kept of a step that was made of this sample.
[[nodiscard]] StepRecord record_of(StepResult result, const Sample& sample, const GlobalMap& map);

struct TrialRecord {
  std::size_t trial = 0;
  std::size_t start_sample = 0;
  int segment = 0;
  double start_m = 0.0;  ///< Along the drive.
  double start_stamp = 0.0;
  Motion motion = Motion::planar;  ///< Says how poses are written.
  std::optional<Pose3> start_reference;
  std::string start_map;  ///< That the reference is on, where there are several.
  Outcome outcome = Outcome::undecided;
  std::size_t steps = 0;                     ///< Up to the declaration; all of them if there is none.
  double distance_m = 0.0;                   ///< Driven in these steps.
  std::optional<Pose3> pose;                 ///< Declared robot pose.
  std::optional<MapPlace> place;             ///< The same, where there are several maps.
  std::optional<Pose3> odom_from_robot;      ///< Odometry at the declaration.
  std::optional<PoseError> error;            ///< Of the declared pose.
  std::optional<PoseEstimate> estimate;      ///< Of the rule that declared it, where it has one.
  std::optional<double> nees;                ///< Normalised error squared of that, where it has a covariance.
  std::optional<Verification> verification;  ///< Of the declaration, where it was verified.
  std::string why;  ///< Of the declaration, of the exception, or else of the last step.
  std::vector<StepRecord>
      records;  ///< Every step, also those after the declaration. Local maps are not kept.
};

/// What to do while trials run; each may be empty.
struct TrialCallbacks {
  std::function<void(const StepRecord&, const Localizer&)> step;
  std::function<bool()>
      stop;  ///< Asked before each step; true gives up the running trial and all later ones.
};

/// The most steps a trial takes; the largest number there is where only the end of the drive limits it.
[[nodiscard]] std::size_t step_limit(const TrialsConfig& config);

/// The most steps that a trial can take which starts at this sample.
[[nodiscard]] std::size_t steps_left(const Drive& drive, const TrialsConfig& config,
                                     std::size_t start_sample);

/// The last step, after the searches that it has left open: the next scan comes later.
[[nodiscard]] StepResult waited_for(Localizer& localizer, StepResult result);

/// A trial before its first step.
[[nodiscard]] TrialRecord begun_trial(const Drive& drive, Motion motion, std::size_t trial,
                                      std::size_t start_sample);

/// Runs one trial: to the first declaration or `max_steps`, or with `whole` to the end of the drive. No trial
/// runs across the end of a segment. One in which a strategy throws an exception has failed and ends there.
/// None if stopped.
[[nodiscard]] std::optional<TrialRecord> run_trial(Localizer& localizer, const Drive& drive,
                                                   const GlobalMap& map, const Experiment& experiment,
                                                   std::size_t trial, std::size_t start_sample,
                                                   const TrialCallbacks& callbacks);

}  // namespace glocal
