// Poses among which a verdict rule cannot decide.
#pragma once

#include <vector>

#include "glocal/step_result.hpp"

namespace glocal::raters {

/// The verdict on robot poses, two or more and the best one first, that are about equally good. Its sentence
/// counts places: poses within a metre of one that is better are at its place, whichever way they look.
[[nodiscard]] Verdict ambiguous(std::vector<Pose3> poses);

}  // namespace glocal::raters
