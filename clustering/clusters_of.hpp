#pragma once

#include <cstddef>
#include <vector>

#include "glocal/hypothesis.hpp"

namespace glocal {

/// Robot poses of hypotheses.
[[nodiscard]] std::vector<Pose2> robot_poses(const std::vector<Hypothesis>& hypotheses);

/// How many proposals each of them stands for.
[[nodiscard]] std::vector<double> supports(const std::vector<Hypothesis>& hypotheses);

/// Clusters of the hypotheses that have the same label, below the number of hypotheses; in the order of their
/// first ones.
[[nodiscard]] std::vector<Cluster> clusters_of(const std::vector<Hypothesis>& hypotheses,
                                               const std::vector<std::size_t>& labels);

}  // namespace glocal
