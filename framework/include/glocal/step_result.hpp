// Everything a localization step has found out.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "glocal/beams.hpp"
#include "glocal/hypothesis.hpp"
#include "glocal/motion.hpp"
#include "glocal/pose3.hpp"
#include "glocal/pose_tolerance.hpp"

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

/// What is known of all poses once the whole map was searched.
struct Certificate {
  /// Of the declared pose: share of points within epsilon of the map, in [0, 1]. In space, and on planar maps
  /// of more than 25 hectares, as voxels count it: they may err by half their diagonal.
  double contact = 0.0;
  double at_most = 0.0;  ///< No rival, found or not, has a larger share: of distances, not of voxels.
  double epsilon = 0.0;  ///< m
  /// m; the search counts for a whole box of poses at once: what it counts is within epsilon + delta of the
  /// map at the middle of the box, and has all that is within epsilon at any pose of it.
  double delta = 0.0;
};

/// What a verifier says of a pose that a verdict rule declares.
struct Verification {
  PoseTolerance near = {};  ///< A pose whose robot is not near the declared one is a rival.
  /// The best ones that the search brought, judged as the matcher judges its own; falling score.
  std::vector<Hypothesis> rivals = {};
  double margin = 0.0;            ///< A rival is about as good if its score is lower by no more.
  double score = 0.0;             ///< Of the declared pose. The localizer sets it.
  bool is_refuted = false;        ///< The localizer sets it.
  std::size_t points_tested = 0;  ///< Looks at a point.
  bool goes_on = false;  ///< The search has not come to its end, and goes on in the next step, or before.
  std::optional<Certificate> certificate = {};  ///< None where the search goes on, or was given up.
  /// Contact of the mirrored local map at the pose where it fits best; none where it fits nowhere better
  /// by the margin than the local map at the declared pose.
  std::optional<double> mirrored_contact = {};
  /// It fits so much better that left and right have changed places, and not the place is like its image.
  bool is_mirrored = false;

  /// Whether a rival is about as good as the declared pose.
  [[nodiscard]] bool is_about_as_good(const Hypothesis& rival) const { return rival.score >= score - margin; }
};

/// Where a robot is thought to be before anything was seen.
struct ExpectedPose {
  Pose3 map_from_robot;
  double odds = 1.0;  ///< Of this pose against all others together, above 0.
};

/// What a verdict rule says, and why.
struct Verdict {
  VerdictKind kind = VerdictKind::searching;
  std::optional<Pose3> map_from_robot = {};   ///< Set when localized.
  std::vector<Pose3> candidates = {};         ///< Robot poses, best first; set when ambiguous.
  std::string why = {};                       ///< One sentence for a person.
  std::optional<PoseEstimate> estimate = {};  ///< None where the rule has none.
  std::vector<Evidence> evidence = {};        ///< For whoever studies the rule.
  /// Localized only if a verifier certifies that no pose elsewhere has more contact.
  bool needs_certificate = false;
};

/// How a robot can be set up wrongly.
enum class SetupFault {
  repeated_scans,  ///< One and the same scan comes again and again.
  upside_down,     ///< The scans turn the other way than odometry.
  mount_angle,     ///< The sensor looks elsewhere than it is said to.
  late_scans,      ///< The scans tell what odometry told some observations before.
  stuck_ranges,    ///< Ranges do not change though the robot moves.
  biased_ranges,   ///< All ranges are too long by the same, or too short.
  mirrored,        ///< The map fits better if left and right change places.
};

/// The name used in YAML, JSON and messages.
[[nodiscard]] const char* to_string(SetupFault fault);

/// What scans and odometry say of the robot's set-up.
struct SetupCheck {
  /// Logarithm of how much more likely these motions are if scans and odometry are of one robot and one time
  /// than if they are not; in [-10, 5], as what was long ago counts less.
  double agreement = 0.0;
  double way_m = 0.0;  ///< Driven in the steps of which both tell the motion, in the last 40.
  /// By which the sensor looks too far to the left; none before something was driven.
  std::optional<double> mount_angle_deg = {};
  /// Of that: a standard deviation, deg.
  double mount_angle_sd_deg = 0.0;
  std::optional<std::size_t> late_by = {};  ///< Observations; where the scans are late.
  /// By which ranges are too long, m; none before a straight wall was seen under 60 degrees.
  std::optional<double> range_bias_m = {};
  std::size_t walls = 0;                 ///< That tell it, one for each time it was seen.
  double stuck_share = 0.0;              ///< Of the last scan's directions, those whose range never changes.
  std::optional<SetupFault> fault = {};  ///< As long as it stands, nothing is declared.
  /// Something speaks against the set-up, or too little for it: nothing is declared yet.
  bool is_in_doubt = false;

  /// The likely cause, and what to do about it; empty without a fault.
  [[nodiscard]] std::string why() const;
};

/// Time of each stage, ms.
struct StageTimes {
  double local_map = 0.0;
  double match = 0.0;
  double cluster = 0.0;
  double rate = 0.0;
  double verify = 0.0;
  double after = 0.0;  ///< Searches that went on after the step had answered (Localizer::go_on).

  /// Until the step answered.
  [[nodiscard]] double answer() const { return local_map + match + cluster + rate + verify; }
  [[nodiscard]] double total() const { return answer() + after; }
};

/// Everything a localization step has found out.
struct StepResult {
  std::size_t step = 0;  ///< Counts from 0 in each trial.
  double stamp = 0.0;
  Motion motion = Motion::planar;  ///< What the localizer was asked for; decides how poses are written.
  Pose3 local_from_robot;
  int local_map_epoch = 0;
  std::size_t local_map_points = 0;

  /// Standard deviation of the ranges so far, m; none in space, or before enough was seen.
  std::optional<double> range_noise;
  double contact_epsilon = 0.0;  ///< m; epsilon of eq. 4 in this step.

  double omega_max = 0.0;             ///< Threshold applied in this step (eq. 9 gives the next one).
  double omega_best = 0.0;            ///< Quality (Omega) of the best hypothesis; 0 without any.
  double score_best = 0.0;            ///< Its score, which omega_max is asked of; 0 without any.
  std::optional<double> omega_place;  ///< Omega' (eq. 10); none before the first hypothesis.
  /// Share of the latest scan's own points in contact at the best hypothesis, of those in known cells; only
  /// in the plane, and none without such a point.
  std::optional<double> omega_scan;
  std::vector<HitKind> hit_kinds;  ///< Of these points, in beam order; empty in space.
  /// The latest scan has hardly a point (fewer than 5, in space 30): what fits does so by older ones alone.
  bool saw_nothing = false;
  std::size_t proposals = 0;      ///< Relations found on both sides: poses before any of them was judged.
  std::size_t points_tested = 0;  ///< Single points tested for contact.

  std::vector<Hypothesis> hypotheses;  ///< Falling score.
  /// Where the robot is now if it was where it was expected, as long as nothing speaks against it.
  std::optional<ExpectedPose> expected;
  std::vector<Cluster> clusters;  ///< Falling rating.
  std::vector<Rating> ratings;    ///< One for each cluster.
  Verdict verdict;
  bool is_matching = false;                  ///< The match goes on, and the step is not judged yet.
  std::optional<Verification> verification;  ///< Of a pose that was declared, or would have been.
  std::optional<SetupCheck> setup;           ///< None where it is not checked: in space.
  StageTimes stage_ms;                       ///< On the wall.
  StageTimes stage_cpu_ms;                   ///< Of all processors that worked for it.

  [[nodiscard]] bool is_verifying() const { return verification && verification->goes_on; }
  /// Whether a search is open with which Localizer::go_on() can go on.
  [[nodiscard]] bool goes_on() const { return is_matching || is_verifying(); }
  /// Robot pose the verdict rule believes in, else that of the best-rated cluster; declared or not.
  [[nodiscard]] std::optional<Pose3> estimate() const {
    if (verdict.estimate) return verdict.estimate->map_from_robot;
    return clusters.empty() ? std::nullopt : std::optional(clusters.front().map_from_robot);
  }
};

}  // namespace glocal
