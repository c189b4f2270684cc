// Keeps the flood of the first steps small without losing a distinct pose.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/hypothesis.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

/// Merges hypotheses whose robot poses lie in the same cell of a pose grid, if there are more than `most` of
/// them. The best of each cell stays and takes over the support of the others. Cells begin at 5 cm and 2
/// degrees and double until no more than `most` are left, so every pose that is distinct at the final cell
/// size keeps a hypothesis. Unless all poses are planar, cells are those of SE(3): x, y, z, and the
/// rotation's axis as long as its angle. `hypotheses` come and stay sorted by falling score; most >= 8.
void merge_hypotheses(std::vector<Hypothesis>& hypotheses, const Pose3& local_from_robot, std::size_t most);

/// Adds what a part of the draws has found to what those before it have.
void append(const MatchResult& part, MatchResult& whole);

/// What chunks of draws have found, in their order, as one answer: sorted, and merged where there are more
/// hypotheses than `most`.
[[nodiscard]] MatchResult joined(const std::vector<MatchResult>& chunks, const Pose3& local_from_robot,
                                 std::size_t most);

}  // namespace glocal
