// Pose hypotheses and their clusters.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "glocal/pose3.hpp"
#include "glocal/pose_covariance.hpp"

namespace glocal {

/// A proposed pose of the local map in the global map (the paper's H).
struct Hypothesis {
  Pose3 map_from_local;
  /// map_from_local * local_from_robot. The localizer sets it; matchers leave it alone, so that the two
  /// cannot disagree.
  Pose3 map_from_robot = {};
  double quality = 0.0;  ///< Omega (eq. 4): share of local map points in contact with the map, in [0, 1].
  /// What its matcher ranks it by, in [0, 1]: Omega, unless more speaks for or against a pose than contact.
  double score = 0.0;
  /// How many proposals it stands for, where a matcher merged those that mean nearly the same pose. Counts as
  /// a weight wherever hypotheses are counted or averaged.
  std::size_t support = 1;
  /// Of map_from_robot, where the matcher knows it.
  std::optional<PoseCovariance> covariance = {};
  /// Share of the points that lie where the map is known to be free, away from anything; where the matcher
  /// knows it.
  std::optional<double> free_space_violation = {};
  /// What beams of scans at different places say for it: a sum over scans, of at most 1 each; where the
  /// matcher knows it. Only differences between poses mean something.
  std::optional<double> beam_evidence = {};

  /// Ranked by contact alone, as in the paper.
  [[nodiscard]] static Hypothesis by_contact(const Pose3& map_from_local, double omega) {
    return {.map_from_local = map_from_local, .quality = omega, .score = omega};
  }
};

/// Hypotheses that mean the same robot pose.
struct Cluster {
  std::vector<std::size_t> members;  ///< Indexes into the step's hypotheses, ascending.
  Pose3 map_from_robot;         ///< Mean; of rotations the one nearest to all, of headings the circular one.
  double variance_x = 0.0;      ///< m^2 (eq. 6, diagonal only)
  double variance_y = 0.0;      ///< m^2
  double variance_theta = 0.0;  ///< rad^2; of the rotation about the map's z axis
  double variance_z = 0.0;      ///< m^2; 0 in the plane, as are those below
  double variance_about_x = 0.0;  ///< rad^2; of the rotation about the map's x axis
  double variance_about_y = 0.0;  ///< rad^2
};

/// How much a cluster deserves trust.
struct Rating {
  double r = 0.0;             ///< eq. 7, in ]0, 1]
  double r_normalised = 0.0;  ///< eq. 8: r divided by the sum of r over all clusters of the step

  friend bool operator==(const Rating&, const Rating&) = default;
};

}  // namespace glocal
