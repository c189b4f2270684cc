// The best poses of a local map anywhere but near a given one.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "glocal/prior.hpp"
#include "matchers/grid_search/box_pyramid.hpp"

namespace glocal {

struct RivalRule {
  double distance = 1.0;                 ///< m; a pose whose robot is farther away than this is a rival …
  double rotation = 0.5235987755982988;  ///< rad; … as is one that is turned by more.
  double cell_distance = 0.4;            ///< m; robot poses in a cell of this diagonal …
  double cell_rotation = 0.2;            ///< rad; … and this size count as one.
  std::size_t most_rivals = 20;
  std::size_t most_looks = 100'000'000;  ///< Of a point at 512 boxes; a longer search is given up.
};

struct RivalSearchResult {
  struct Rival {
    Pose3 map_from_local;
    std::size_t in_contact = 0;  ///< Points that can be in contact near there.
  };
  std::vector<Rival> rivals = {};  ///< At least `least`; falling contact.
  /// No pose that is a rival has more points in contact. If there is no rival, `least` - 1.
  std::size_t at_most = 0;
  std::size_t looks = 0;
  bool is_complete = false;  ///< If not, the search was given up, and says nothing.
};

/// Searches all poses that a gate allows, but for those near one robot pose, for such that can bring at least
/// `least` of the points into contact: by branch and bound on boxes of poses (box_pyramid.hpp), down to boxes
/// of one cell and of rotations that move the farthest point by one. What it leaves out cannot reach `least`
/// anywhere in its box. At least one point, and of more than TileCounts::most_points the search is given up;
/// `least` at least 1.
///
/// Over a pyramid in the plane the poses are those of the plane. In space they are those at which the local
/// frame stands upright in the map: x, y, z and yaw.
[[nodiscard]] RivalSearchResult search_rivals(const BoxPyramid& pyramid, const Points& points,
                                              const Pose3& local_from_robot, const Pose3& map_from_robot,
                                              std::size_t least, const RivalRule& rule, const PoseGate& gate,
                                              int threads);

}  // namespace glocal
