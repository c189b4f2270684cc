// Branch and bound over boxes of poses: no pose that is good enough is missed.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "glocal/pose_tolerance.hpp"
#include "glocal/prior.hpp"
#include "matchers/box_search/box_pyramid.hpp"
#include "matchers/box_search/pose_boxes.hpp"

namespace glocal {

struct BoxSearchRule {
  std::size_t least = 1;       ///< Points that must be able to be in contact; at least 1.
  double cell_distance = 0.4;  ///< m; robot poses in a cell of this diagonal …
  double cell_rotation = 0.2;  ///< rad; … and this size count as one.
  std::size_t most_places = 50;
  /// A longer search is given up. At a point, for the 512 boxes of a tile.
  std::size_t most_looks = std::numeric_limits<std::size_t>::max();
  double min_rotation_step = 0.005;  ///< rad; of a grid, see PoseGrid.
  PoseGate gate = {};                ///< Only poses that it allows are searched for.
};

/// Robot poses that are not searched for: those near this one.
struct Exclusion {
  Pose3 map_from_robot;
  PoseTolerance near = {};
};

struct BoxSearchResult {
  /// The pose at the middle of the best box of a cell of robot poses.
  struct FoundPose {
    Pose2 map_from_local;        ///< Seen from above; where poses tilt, after the tilt.
    double z = 0.0;              ///< Of the local frame's origin in the map, m; 0 in the plane.
    std::size_t in_contact = 0;  ///< Points, by the cells that they lie in.
    std::optional<Pose3> tilted_from_local = {};  ///< Where poses tilt.

    [[nodiscard]] Pose3 pose() const {
      const Pose3 upright({map_from_local.x, map_from_local.y, z}, turn_about_z(map_from_local.theta));
      return tilted_from_local ? upright * *tilted_from_local : upright;
    }
  };
  std::vector<FoundPose> poses = {};  ///< Falling contact.
  /// No pose that was searched for has more points in contact. If nothing was found, `least` - 1.
  std::size_t at_most = 0;
  std::size_t tested = 0;    ///< Boxes of the lowest level whose points were counted.
  std::size_t looks = 0;     ///< At a point, for the 512 boxes of a tile.
  bool is_complete = false;  ///< If not, the search was given up, and says nothing.
};

/// The best places of a local map: of each cell of robot poses, among the boxes that can bring at least
/// `least` of the points into contact, the one with the most contact at its middle; of the pyramid's grid or
/// of all poses. What is left out cannot reach `least` anywhere in its box, or its middle is excluded. Of all
/// poses, the smallest boxes are one cell wide, and their rotations move the farthest point by one. At least
/// one point, and of more than TileCounts::most_points the search is given up.
///
/// Where there would be more than `most_places`, these are the best of them (any, where several are equally
/// good as the last). As soon as so many are known, no box that cannot beat the last of them is searched.
/// The answer does not depend on the number of threads.
///
/// Over a pyramid in the plane the poses are those of the plane. Over one of upright motion they are those at
/// which the local frame stands upright in the map: x, y, z and yaw. Over one of free motion they are those
/// at which it is tilted by at most TiltSquares::most_tilt.
[[nodiscard]] BoxSearchResult search_boxes(const BoxPyramid& pyramid, const Points& points,
                                           const Pose3& local_from_robot, const BoxSearchRule& rule,
                                           const std::optional<Exclusion>& exclusion, int threads);

namespace box_search {
class State;
}

/// The same search in pieces. How it is divided changes nothing of what it finds.
class BoxSearch {
 public:
  static constexpr std::size_t to_the_end = std::numeric_limits<std::size_t>::max();

  /// As search_boxes(). The pyramid must live as long as the search.
  BoxSearch(const BoxPyramid& pyramid, Points points, const Pose3& local_from_robot,
            const BoxSearchRule& rule, const std::optional<Exclusion>& exclusion, int threads);
  BoxSearch(BoxSearch&&) noexcept;
  BoxSearch& operator=(BoxSearch&&) noexcept;
  ~BoxSearch();

  /// Goes on part by part until no looks are left, or to the end. What a part takes is no longer left: to lay
  /// points into cells takes time, too. The last part may take more than there was. Returns at how many
  /// points it looked.
  std::size_t advance(std::size_t& looks_left);
  [[nodiscard]] bool is_over() const;
  /// Once it is over.
  [[nodiscard]] BoxSearchResult result() const;

 private:
  std::unique_ptr<box_search::State> state_;  ///< None where nothing is to be searched …
  BoxSearchResult over_;                      ///< … and this is all that is to be said.
};

}  // namespace glocal
