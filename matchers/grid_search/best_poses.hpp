// The best poses of a search of a grid: one in each cell of robot poses.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/pose_cells.hpp"

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
};

/// By cells of robot poses.
using BestOfCells = std::map<PoseCell, GridPose>;

/// The cells that the robot is in at the poses of one rotation of a grid.
class RobotCells {
 public:
  /// `robot_at_zero`: the robot in the map before any translation; `cell`: what translations are multiples of
  /// (m).
  RobotCells(const Pose2& robot_at_zero, double cell, const GridSearchRule& rule);
  [[nodiscard]] PoseCell of(const GridPose& pose) const;

 private:
  Pose2 robot_at_zero_;
  double cell_;
  PoseBinning binning_;  ///< Of robot poses.
};

/// Keeps the better of a cell's poses: more contact; then the first in the grid, so that the order of the
/// search does not matter.
void add(BestOfCells& best, const PoseCell& cell, const GridPose& pose);

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
  /// The best first; map_from_local of a grid pose is `pose_of(pose)`.
  template <class PoseOf>
  [[nodiscard]] GridSearchResult result(PoseOf pose_of) const {
    GridSearchResult result{.poses = {}, .tested = tested_, .points_tested = points_tested_};
    for (const GridPose& pose : poses()) result.poses.push_back({pose_of(pose), pose.in_contact});
    return result;
  }

 private:
  void raise();
  [[nodiscard]] std::vector<GridPose> poses() const;

  std::size_t most_;
  std::size_t least_;
  BestOfCells best_;
  std::size_t tested_ = 0, points_tested_ = 0;
};

}  // namespace glocal
