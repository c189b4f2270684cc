// The best poses of a search of a grid: one in each cell of robot poses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/pose_cells.hpp"
#include "glocal/prior.hpp"
#include "matchers/grid_search/contact_pyramid.hpp"
#include "matchers/grid_search/pose_grid.hpp"

namespace glocal {

struct GridSearchRule {
  double min_quality = 0.0;          ///< Share of points in contact that a pose must reach.
  double min_rotation_step = 0.005;  ///< rad; see PoseGrid.
  double distance = 0.4;             ///< m; robot poses in a cell of this diagonal …
  double rotation = 0.2;             ///< rad; … and this size count as one.
  std::size_t max_poses = 50;
  PoseGate gate = {};  ///< Only poses that it allows are searched for.
};

struct GridSearchResult {
  struct Pose {
    Pose2 map_from_local;        ///< Seen from above.
    double z = 0.0;              ///< Of the local frame's origin in the map, m; 0 in the plane.
    std::size_t in_contact = 0;  ///< Points.
  };
  std::vector<Pose> poses;        ///< Falling contact.
  std::size_t tested = 0;         ///< Grid poses whose points were counted.
  std::size_t points_tested = 0;  ///< Looks at a point; what one look serves depends on the search.
};

/// A pose of a PoseGrid.
struct GridPose {
  std::size_t in_contact = 0;
  std::size_t rotation = 0;
  int row = 0;
  int column = 0;
  int layer = 0;  ///< 0 in the plane.
};

/// A cell of robot poses.
struct RobotCell {
  PoseCell place;
  std::int64_t layer = 0;  ///< 0 in the plane.

  friend bool operator<(const RobotCell& a, const RobotCell& b) {
    return std::tie(a.place, a.layer) < std::tie(b.place, b.layer);
  }
};

using BestOfCells = std::map<RobotCell, GridPose>;

/// The cells that the robot is in at the poses of one rotation of a grid.
class RobotCells {
 public:
  /// `robot_at_zero`: the robot in the map before any translation, and its height there (m, 0 in the plane);
  /// `cell`: what translations are multiples of (m).
  RobotCells(const Pose2& robot_at_zero, double height_at_zero, double cell, const GridSearchRule& rule);
  [[nodiscard]] RobotCell of(const GridPose& pose) const;

 private:
  Pose2 robot_at_zero_;
  double height_at_zero_;
  double cell_;
  PoseBinning binning_;  ///< Of robot poses.
};

/// Keeps the better of a cell's poses: more contact; then the first in the grid, so that the order of the
/// search does not matter.
void add(BestOfCells& best, const RobotCell& cell, const GridPose& pose);

/// What has been found in one rotation of a grid.
struct FoundPoses {
  BestOfCells best;
  std::size_t tested = 0;  ///< See GridSearchResult.
  std::size_t points_tested = 0;
};

/// The best poses so far, and what a pose must reach to become one of them.
class BestPoses {
 public:
  /// Of a local map of so many points.
  BestPoses(const GridSearchRule& rule, std::size_t points);

  /// Takes in what some rotations held. If there are as many poses as are wanted, only what beats the last of
  /// them will do from now on.
  void add(const std::vector<FoundPoses>& found);

  /// Points in contact.
  [[nodiscard]] std::size_t least() const { return least_; }
  /// The best first: poses of a grid over the cells of a frame.
  [[nodiscard]] GridSearchResult result(const PoseGrid& grid, const CellFrame& frame) const;

 private:
  void raise();
  [[nodiscard]] std::vector<GridPose> poses() const;

  std::size_t most_;
  std::size_t least_;
  BestOfCells best_;
  std::size_t tested_ = 0, points_tested_ = 0;
};

}  // namespace glocal
