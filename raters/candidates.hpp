// Poses among which a verdict rule cannot decide.
#pragma once

#include <optional>
#include <vector>

#include "glocal/step_result.hpp"

namespace glocal::raters {

/// The verdict on robot poses, the best one first, that are about equally good, if they are two to ten: with
/// more the robot is still searching. Its sentence counts places: poses within a metre of one that is better
/// are at its place, whichever way they look.
[[nodiscard]] std::optional<Verdict> ambiguous(std::vector<Pose3> poses);

}  // namespace glocal::raters
