// From a pose to one near it with more contact.
#pragma once

#include "glocal/contact.hpp"
#include "glocal/motion.hpp"
#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal::verifiers {

/// Goes from a pose to its best neighbour, as long as that has more contact: a step (m) along x, y or z, or a
/// turn about the middle of the points that moves the farthest of them by a step; about the z axis, and where
/// the motion is free about x and y, too. Then once more with half the step, and with a quarter of it. At
/// least one point.
[[nodiscard]] Pose3 climbed_pose(const ContactIndex& contact, const Points& points,
                                 const Pose3& map_from_points, double step, Motion motion);

}  // namespace glocal::verifiers
