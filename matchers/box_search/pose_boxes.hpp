// The boxes of poses that an exact search divides.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/motion.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/pose3.hpp"
#include "matchers/box_search/cell_frame.hpp"
#include "matchers/box_search/tilt_squares.hpp"
#include "matchers/box_search/window_bits.hpp"

namespace glocal {

/// Translations by whole cells and, in space, layers of them, from the first to the last.
struct Translations {
  int first_column, last_column;
  int first_row, last_row;
  int first_layer = 0, last_layer = 0;
};

/// Poses of a local map in boxes: in the plane, or in space, upright or tilted. The points are turned by an
/// interval of angles about the middle of the rectangle they fill, then moved by [column, column + 2^l) cells
/// and rows likewise; in space also by [layer, layer + layers_of_box(l)) layers. Where poses tilt, an
/// interval has tilts, too: the points are tilted about their middle first.
class PoseBoxes {
 public:
  virtual ~PoseBoxes() = default;
  PoseBoxes(const PoseBoxes&) = delete;
  PoseBoxes& operator=(const PoseBoxes&) = delete;

  /// How many intervals of rotations a level has.
  [[nodiscard]] virtual std::size_t rotations(int level) const = 0;
  /// Those of the level below that an interval has.
  [[nodiscard]] virtual std::vector<std::size_t> parts(int level, std::size_t rotation) const = 0;
  /// By which the points are turned in the middle of an interval, rad.
  [[nodiscard]] virtual double angle(int level, std::size_t rotation) const = 0;
  /// How far from the middle of an interval its rotations can be, rad.
  [[nodiscard]] virtual double half_width(int level) const = 0;
  /// In the middle of an interval: the local frame after its tilt, from before.
  [[nodiscard]] virtual Pose3 tilted_from_local(int /*level*/, std::size_t /*rotation*/) const { return {}; }
  [[nodiscard]] virtual int layers_of_box(int level) const = 0;
  /// The points turned but not moved, by the windows of a BoxPyramid that they look at: for each group of
  /// points with windows of one size those cells that a window is named by.
  [[nodiscard]] virtual std::vector<CellPoints> cells(int level, std::size_t rotation) const = 0;
  /// All after which at least so many of a top level's points (cells()) can be in contact.
  [[nodiscard]] virtual Translations translations(const std::vector<CellPoints>& cells,
                                                  std::size_t least) const = 0;

  [[nodiscard]] const CellFrame& frame() const { return frame_; }
  /// How far the rotations of an interval move a place of the local frame from where its middle puts it, m.
  [[nodiscard]] double sway(int level, const Vector3& local) const;
  /// For the middle of an interval and a translation in cells: the local frame after its tilt in the map,
  /// seen from above.
  [[nodiscard]] Pose2 pose(int level, std::size_t rotation, double column, double row) const;
  /// Its height after a translation in layers, m; 0 in the plane.
  [[nodiscard]] double height(double layer) const {
    return frame_.in_space ? frame_.min_z + frame_.cell * layer - tilt_height_.value_or(0.0) : 0.0;
  }
  [[nodiscard]] bool tilt() const { return tilt_height_.has_value(); }

 protected:
  /// At least one point.
  PoseBoxes(const Points& points, const CellFrame& frame, Motion motion);
  [[nodiscard]] double middle_x() const { return middle_x_; }
  [[nodiscard]] double middle_y() const { return middle_y_; }
  /// About which the points turn and tilt; where they do not tilt, at height 0.
  [[nodiscard]] Vector3 middle() const { return {middle_x_, middle_y_, tilt_height_.value_or(0.0)}; }

 private:
  CellFrame frame_;
  double middle_x_, middle_y_;
  std::optional<double> tilt_height_;  ///< Of the middle that poses tilt about, m.
};

/// The poses of a grid: rotations by whole steps, and translations by whole cells. Once turned, each point
/// lies in the cell that its coordinates over the side of a cell, rounded down, name, and translations keep
/// it in the same place within its cell. So what cells the points of a grid pose lie in is a matter of
/// integers. In space, so it is with layers: heights do not change as the points are turned.
class PoseGrid final : public PoseBoxes {
 public:
  /// A rotation by one step moves the farthest point by one cell, but is not smaller than `min_rotation_step`
  /// (rad) and at most 0.1 rad. At least one point. In space poses leave the robot, which is at a height (m)
  /// in the local frame, at the height of one of the frame's layers.
  PoseGrid(const Points& points, const CellFrame& frame, double min_rotation_step, double robot_height = 0.0);

  [[nodiscard]] std::size_t rotations(int /*level*/) const override { return rotations_; }
  /// On a grid they are the same at all levels.
  [[nodiscard]] std::vector<std::size_t> parts(int /*level*/, std::size_t rotation) const override {
    return {rotation};
  }
  /// In [0, 2 pi), rad.
  [[nodiscard]] double angle(int level, std::size_t rotation) const override;
  [[nodiscard]] double half_width(int /*level*/) const override { return 0.0; }
  [[nodiscard]] int layers_of_box(int level) const override { return frame().in_space ? 1 << level : 1; }
  /// One group, for all levels the same: the cells that the points lie in.
  [[nodiscard]] std::vector<CellPoints> cells(int level, std::size_t rotation) const override;
  /// `least` is taken for 1.
  [[nodiscard]] Translations translations(const std::vector<CellPoints>& cells,
                                          std::size_t least) const override;

 private:
  const Points& points_;
  double robot_height_;
  std::vector<std::int32_t> layers_;  ///< Of the points.
  std::size_t rotations_;
};

/// All poses: translations by any real numbers. An interval of level l moves the farthest point by 2^l cells;
/// its parts are its halves. In space boxes of a level begin at whole multiples of their height.
///
/// Where the motion is free, an interval has a square of tilts, too, and its parts have the quarters. They
/// move points by up to `rise` layers up and down, and aside by as much again as turns do.
class AllPoses final : public PoseBoxes {
 public:
  AllPoses(const Points& points, const CellFrame& frame, int top_level, Motion motion = Motion::planar);

  [[nodiscard]] std::size_t rotations(int level) const override;
  [[nodiscard]] std::vector<std::size_t> parts(int level, std::size_t rotation) const override;
  [[nodiscard]] double angle(int level, std::size_t rotation) const override;
  [[nodiscard]] double half_width(int level) const override;
  [[nodiscard]] Pose3 tilted_from_local(int level, std::size_t rotation) const override;
  /// Half of the turns of an interval, rad.
  [[nodiscard]] double half_turn(int level) const;
  /// Where poses tilt.
  [[nodiscard]] const std::optional<TiltSquares>& tilts() const { return tilts_; }
  /// Half of the cells that a box is wide, so that windows, which are twice as high as a box and begin at
  /// whole multiples of that, are hardly higher than they are wide.
  [[nodiscard]] static int layers_of_box(int level, const CellFrame& frame) {
    return frame.in_space && level > 0 ? (1 << level) / 2 : 1;
  }
  [[nodiscard]] int layers_of_box(int level) const override { return layers_of_box(level, frame()); }

  /// How many layers an interval's tilts move a point up or down, at most.
  [[nodiscard]] static int rise(int level, Motion motion) { return motion == Motion::free ? 1 << level : 0; }
  /// How many layers the window of a point has, so that its box and all that moves it lie in one.
  [[nodiscard]] static int layers_of_window(int level, const CellFrame& frame, Motion motion) {
    return frame.in_space ? 2 * (layers_of_box(level, frame) + rise(level, motion)) : 1;
  }

  /// How many groups a level has: points of group g (from 1 on) are moved by at most g / groups of what turns
  /// move the farthest point by.
  [[nodiscard]] static int groups(int level) { return level == 0 ? 1 : level == 1 ? 2 : 4; }
  /// How many cells the window of a point is wider than its box: what moves it, and one, as it lies anywhere
  /// in its cell.
  [[nodiscard]] static int wider(int level, int group) { return 1 + group * ((1 << level) / groups(level)); }
  /// The cell behind the first one that an interval can put a point into, by as much as the window is wider;
  /// and the box of layers that it is in.
  [[nodiscard]] std::vector<CellPoints> cells(int level, std::size_t rotation) const override;
  [[nodiscard]] Translations translations(const std::vector<CellPoints>& cells,
                                          std::size_t least) const override;

  /// cells() of the clusters, at the top level: in each of them a window is wider by its radius, too. The
  /// points of one are in one box of layers. Where poses tilt there are none.
  [[nodiscard]] std::vector<CellPoints> cluster_cells(std::size_t rotation) const;
  /// So many neighbouring points at a time are a cluster: all of them are in contact if its window is, for
  /// all that is known. Some points are in none.
  static constexpr std::size_t cluster_size = 4;
  [[nodiscard]] std::size_t points_without_cluster() const {
    return points_.size() - cluster_size * clusters_.size();
  }
  /// Of clusters, and of points that tilt, which may move twice as far.
  [[nodiscard]] static int wide_groups(int level) { return 2 * groups(level); }
  [[nodiscard]] static int groups_of_points(int level, Motion motion) {
    return motion == Motion::free ? wide_groups(level) : groups(level);
  }
  /// The cells that the points of level 0 lie in at the middle of each box.
  [[nodiscard]] CellPoints middle_cells(std::size_t rotation) const;

 private:
  /// What turns about the middle: a point, or a disc of them.
  struct Turning {
    double x, y;  ///< m, from the middle.
    double distance;
    double radius = 0.0;
    double layer = 0.0;  ///< How high, in layers; 0 in the plane.
  };
  /// An interval of a level.
  struct Rotations {
    std::size_t turn;                ///< Its number.
    Vector3 tilt = Vector3::Zero();  ///< Its middle, a rotation vector.
  };
  [[nodiscard]] Rotations rotations_of(int level, std::size_t rotation) const;
  [[nodiscard]] Motion motion() const { return tilts_ ? Motion::free : Motion::upright; }
  [[nodiscard]] TiltSquares largest_tilts() const;
  [[nodiscard]] Turning tilted(const Turning& one, const Quaternion& tilt) const;
  [[nodiscard]] std::int32_t box_of_layers(int level, const Turning& one) const;
  void find_clusters(double widest);
  /// The disc about some points.
  [[nodiscard]] Turning disc_about(const std::vector<std::uint32_t>& members) const;
  void put_rare_first(std::vector<Turning>& all) const;
  [[nodiscard]] std::vector<CellPoints> cells_of(const std::vector<Turning>& all, int groups, int level,
                                                 std::size_t rotation) const;

  int top_level_;
  double radius_ = 0.0;          ///< Of the farthest point, m.
  std::vector<Turning> points_;  ///< From the middle; those at rare heights first, then by rising distance.
  std::vector<Turning> clusters_;
  std::size_t top_turns_ = 1;
  std::optional<TiltSquares> tilts_;
};

}  // namespace glocal
