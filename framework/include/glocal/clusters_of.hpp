// Clusters of hypotheses, for clusterers.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/hypothesis.hpp"
#include "glocal/moments.hpp"

namespace glocal {

/// Robot poses of hypotheses, as Pose2 seen from above.
template <class Pose>
[[nodiscard]] std::vector<Pose> robot_poses(const std::vector<Hypothesis>& hypotheses) {
  std::vector<Pose> poses;
  poses.reserve(hypotheses.size());
  for (const Hypothesis& h : hypotheses) poses.push_back(pose_as<Pose>(h.map_from_robot));
  return poses;
}

/// How many proposals each of them stands for.
[[nodiscard]] std::vector<double> supports(const std::vector<Hypothesis>& hypotheses);

/// Clusters of the hypotheses that have the same label, in the order of their first ones, each with the mean
/// and the variances of its robot poses (make_cluster()). Throws std::invalid_argument unless there is a
/// label for each hypothesis, below the number of hypotheses.
[[nodiscard]] std::vector<Cluster> clusters_of(const std::vector<Hypothesis>& hypotheses,
                                               const std::vector<std::size_t>& labels);

}  // namespace glocal
