// Everything a localization step has found out.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "glocal/hypothesis.hpp"
#include "glocal/motion.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// What a step says of the robot's place.
enum class VerdictKind {
  searching,      ///< Nothing can be said yet.
  ambiguous,      ///< Several poses explain the observations; `candidates` lists them.
  localized,      ///< `map_from_robot` can be trusted.
  unknown_place,  ///< The robot is somewhere the map does not show.
};

/// The name used in YAML, JSON and messages.
[[nodiscard]] const char* to_string(VerdictKind kind);

/// The pose a verdict rule holds most likely, declared or not.
struct PoseEstimate {
  Pose3 map_from_robot;
  double confidence = 0.0;  ///< Probability that it is right, in [0, 1].
  std::optional<PoseCovariance> covariance = {};
};

/// A number that a verdict rests on.
struct Evidence {
  std::string name;  ///< With its unit: "distance_m".
  double value = 0.0;
};

/// What a verdict rule says, and why.
struct Verdict {
  VerdictKind kind = VerdictKind::searching;
  std::optional<Pose3> map_from_robot;        ///< Set when localized.
  std::vector<Pose3> candidates;              ///< Robot poses, best first; set when ambiguous.
  std::string why;                            ///< One sentence for a person.
  std::optional<PoseEstimate> estimate = {};  ///< None where the rule has none.
  std::vector<Evidence> evidence = {};        ///< For whoever studies the rule.
};

/// Wall-clock time of each stage, ms.
struct StageTimes {
  double local_map = 0.0;
  double match = 0.0;
  double cluster = 0.0;
  double rate = 0.0;

  [[nodiscard]] double total() const { return local_map + match + cluster + rate; }
};

/// Everything a localization step has found out.
struct StepResult {
  std::size_t step = 0;  ///< Counts from 0 in each trial.
  double stamp = 0.0;
  Motion motion = Motion::planar;  ///< What the localizer was asked for; decides how poses are written.
  Pose3 local_from_robot;
  int local_map_epoch = 0;
  std::size_t local_map_points = 0;

  double omega_max = 0.0;             ///< Threshold applied in this step (eq. 9 gives the next one).
  double omega_best = 0.0;            ///< Quality (Omega) of the best hypothesis; 0 without any.
  double score_best = 0.0;            ///< Its score, which omega_max is asked of; 0 without any.
  std::optional<double> omega_place;  ///< Omega' (eq. 10); none before the first hypothesis.
  std::size_t proposals = 0;          ///< Relations found on both sides: poses before any of them was judged.
  std::size_t points_tested = 0;      ///< Single points tested for contact.

  std::vector<Hypothesis> hypotheses;  ///< Falling score.
  std::vector<Cluster> clusters;       ///< Falling rating.
  std::vector<Rating> ratings;         ///< One for each cluster.
  Verdict verdict;
  StageTimes stage_ms;

  /// Robot pose the verdict rule believes in, else that of the best-rated cluster; declared or not.
  [[nodiscard]] std::optional<Pose3> estimate() const {
    if (verdict.estimate) return verdict.estimate->map_from_robot;
    return clusters.empty() ? std::nullopt : std::optional(clusters.front().map_from_robot);
  }
};

}  // namespace glocal
