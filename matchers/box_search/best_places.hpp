// What an exact search has found: the best box in each cell of robot poses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/pose_cells.hpp"

namespace glocal {

/// A box of level 0 (PoseBoxes); of a grid, a pose.
struct Box {
  std::size_t rotation = 0;
  int row = 0, column = 0;
  int layer = 0;              ///< 0 in the plane.
  std::size_t at_middle = 0;  ///< Points in contact at its middle.

  /// Whether more points are in contact at its middle; of several, whether it is the first in the order of
  /// poses, so that the order of the search does not matter.
  [[nodiscard]] bool is_better_than(const Box& other) const {
    return std::tie(other.at_middle, rotation, layer, row, column) <
           std::tie(at_middle, other.rotation, other.layer, other.row, other.column);
  }
};

/// A cell of robot poses.
struct RobotCell {
  PoseCell place;
  std::int64_t layer = 0;  ///< 0 in the plane.

  friend bool operator<(const RobotCell& a, const RobotCell& b) {
    return std::tie(a.place, a.layer) < std::tie(b.place, b.layer);
  }
};

/// The cells that the robot is in at the boxes of one rotation.
class RobotCells {
 public:
  /// `robot_at_zero`: the robot in the map before any translation, and its height there (m, 0 in the plane);
  /// `cell`: what translations are multiples of (m). Robot poses in a cell of this diagonal `distance` (m)
  /// and size `rotation` (rad) count as one.
  RobotCells(const Pose2& robot_at_zero, double height_at_zero, double cell, double distance,
             double rotation);
  [[nodiscard]] RobotCell of(const Box& box) const;

 private:
  Pose2 robot_at_zero_;
  double height_at_zero_;
  double cell_;
  PoseBinning binning_;  ///< Of robot poses.
};

/// The best box of each cell.
using BestOfCells = std::map<RobotCell, Box>;

void take_in(BestOfCells& places, const RobotCell& cell, const Box& box);

/// Leaves those that are as good as the last of the best `most`, at least one, and returns how many points
/// are in contact there; 0, and leaves all, if there are fewer.
std::size_t keep_best(BestOfCells& places, std::size_t most);

/// What has been found in one interval of rotations.
struct FoundPlaces {
  BestOfCells places = {};
  std::size_t at_most = 0;  ///< No pose of these places and of those left out has more points in contact.
  std::size_t tested = 0;   ///< Boxes of level 0 whose points were counted.
  std::size_t looks = 0;    ///< At a point; what one look serves depends on the search.
};

/// The best places so far, and what a box must reach to be one of them.
class BestPlaces {
 public:
  /// The best `most` of those whose boxes can have at least `least` points in contact.
  BestPlaces(std::size_t most, std::size_t least) : most_(most), bar_(least) {}

  void add(const BestOfCells& found);
  /// If there are as many as are wanted, only boxes that can beat the last of them will do from now on. For
  /// all that was added, or places that are as good as the last are lost.
  void raise();

  /// Points in contact.
  [[nodiscard]] std::size_t bar() const { return bar_; }
  /// The best first.
  [[nodiscard]] std::vector<Box> falling() const;

 private:
  std::size_t most_;
  std::size_t bar_;
  BestOfCells places_;
};

}  // namespace glocal
