// Branch and bound over all poses of a grid: nothing good enough is missed.
#pragma once

#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "matchers/grid_search/best_poses.hpp"
#include "matchers/grid_search/contact_pyramid.hpp"

namespace glocal {

/// The poses of a PoseGrid over the pyramid's cells that bring at least one point and the share asked for
/// into contact: the best of each cell of robot poses. Exactly those: every grid pose that reaches
/// min_quality has one at least as good in its cell.
///
/// Where there would be more than max_poses, these are the best of them (any, where several are equally good
/// as the last). As soon as so many are known, nothing that does not beat the last of them is searched.
///
/// `points_tested` counts looks at a point, each of which serves the 512 nodes of a tile.
/// All rotations are searched depth first from the top of the pyramid, those that look best in a first look
/// before the others. The answer does not depend on the number of threads.
///
/// Over a pyramid in space, the local frame stands upright in the map, and translations are by whole layers,
/// too: all that leave the robot, which is at `robot_height` (m) in the local frame, at the height of one of
/// the pyramid's layers.
[[nodiscard]] GridSearchResult search_grid(const ContactPyramid& pyramid, const Points& points,
                                           const Pose2& local_from_robot, const GridSearchRule& rule,
                                           int threads, double robot_height = 0.0);

}  // namespace glocal
