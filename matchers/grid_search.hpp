// Branch and bound over all poses of a grid: nothing good enough is missed.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "matchers/contact_pyramid.hpp"

namespace glocal {

struct GridSearchRule {
  double min_quality = 0.0;          ///< Share of points in contact that a pose must reach.
  double min_rotation_step = 0.005;  ///< rad; see PoseGrid.
  double distance = 0.4;             ///< m; robot poses in a cell of this diagonal …
  double rotation = 0.2;             ///< rad; … and this size count as one.
  std::size_t max_poses = 50;
};

struct GridSearchResult {
  struct Pose {
    Pose2 map_from_local;
    std::size_t in_contact = 0;  ///< Points.
  };
  std::vector<Pose> poses;  ///< Falling contact.
  std::size_t tested = 0;   ///< Grid poses whose points were counted.
  std::size_t checks = 0;   ///< Looks at a point; one look serves the 512 nodes of a tile.
};

/// The poses of a PoseGrid over the pyramid's cells that bring at least one point and the share asked for
/// into contact: the best of each cell of robot poses. Exactly those: every grid pose that reaches
/// min_quality has one at least as good in its cell.
///
/// Where there would be more than max_poses, these are the best of them (any, where several are equally good
/// as the last). As soon as so many are known, nothing that does not beat the last of them is searched.
///
/// All rotations are searched depth first from the top of the pyramid, those that look best in a first look
/// before the others. The answer does not depend on the number of threads.
[[nodiscard]] GridSearchResult search_grid(const ContactPyramid& pyramid, const Points& points,
                                           const Pose2& local_from_robot, const GridSearchRule& rule,
                                           int threads);

}  // namespace glocal
