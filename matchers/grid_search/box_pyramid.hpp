// How many points of a local map can be in contact, at most, over boxes of poses.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/motion.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "matchers/grid_search/contact_pyramid.hpp"
#include "matchers/grid_search/window_bits.hpp"

namespace glocal {

/// The boxes that together are all poses of a local map in the plane, or all upright ones in space:
/// translations by [column, column + 2^l) and [row, row + 2^l) cells, any real numbers, after rotations by an
/// interval of angles about the middle of the points. An interval of level l moves the farthest point by 2^l
/// cells; its halves are those of level l - 1. In space, where boxes are h layers high, box of layers k
/// stands for the translations by [k h, (k + 1) h) layers.
class PoseBoxes {
 public:
  /// At least one point; translations are those to the cells of `frame`, in the plane or in space as it is.
  PoseBoxes(const Points& points, const CellFrame& frame, int top_level);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] std::size_t rotations(int level) const { return top_rotations_ << (top_level_ - level); }
  /// The middle of an interval, rad.
  [[nodiscard]] double angle(int level, std::size_t rotation) const;
  /// Half of its width, rad.
  [[nodiscard]] double half_width(int level) const;
  /// How far the rotations of an interval move a place of the local frame to either side, m.
  [[nodiscard]] double sway(int level, double local_x, double local_y) const;
  /// map_from_local for the middle of an interval and a translation in cells.
  [[nodiscard]] Pose2 pose(int level, std::size_t rotation, double column, double row) const;
  /// Its height after a translation in layers, m; 0 in the plane.
  [[nodiscard]] double height(double layer) const {
    return frame_.in_space ? frame_.min_z + frame_.cell * layer : 0.0;
  }

  /// How high a box is, in layers; 1 in the plane. It is half as high as it is wide, so that windows, which
  /// are twice as high and begin at whole multiples of it, are hardly higher than they are wide.
  [[nodiscard]] static int layers_of_box(int level, const CellFrame& frame) {
    return frame.in_space ? std::max(1, (1 << level) / 2) : 1;
  }
  /// m; 0 in the plane.
  [[nodiscard]] double box_height(int level) const {
    return frame_.in_space ? frame_.cell * layers_of_box(level, frame_) : 0.0;
  }
  /// How many groups a level has: points of group g (from 1 on) are moved by at most g / groups of what the
  /// farthest point is.
  [[nodiscard]] static int groups(int level) { return level == 0 ? 1 : level == 1 ? 2 : 4; }
  /// How many cells the window of a point is wider than its node.
  [[nodiscard]] static int wider(int level, int group) { return 1 + group * ((1 << level) / groups(level)); }
  /// The points of each group, turned but not moved: the cell behind the first one that an interval can put
  /// them into, by as much as the window is wider; and the box of layers that they are in.
  [[nodiscard]] std::vector<CellPoints> cells(int level, std::size_t rotation) const;
  /// The same of the clusters, at the top level: in each of them a window is wider by its radius, too. The
  /// points of one are in one box of layers.
  [[nodiscard]] std::vector<CellPoints> cluster_cells(std::size_t rotation) const;
  /// So many neighbouring points at a time are a cluster: all of them are in contact if its window is, for
  /// all that is known. Some points are in none.
  static constexpr std::size_t cluster_size = 4;
  [[nodiscard]] std::size_t points_without_cluster() const {
    return points_.size() - cluster_size * clusters_.size();
  }
  [[nodiscard]] static int cluster_groups(int level) { return 2 * groups(level); }
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
  [[nodiscard]] std::int32_t box_of_layers(int level, const Turning& one) const;
  void find_clusters(double widest);
  void put_rare_first(std::vector<Turning>& all) const;
  [[nodiscard]] std::vector<CellPoints> cells_of(const std::vector<Turning>& all, int groups, int level,
                                                 std::size_t rotation) const;

  CellFrame frame_;
  int top_level_;
  double middle_x_, middle_y_;
  double radius_ = 0.0;          ///< Of the farthest point, m.
  std::vector<Turning> points_;  ///< From the middle; those at rare heights first, then by rising distance.
  std::vector<Turning> clusters_;
  std::size_t top_rotations_ = 1;
};

/// Windows over the cells that are anywhere within epsilon of a map: for each level and group those that the
/// points of a box can meet. A point whose window is empty is in contact at no pose of the box. In space
/// windows are twice as high as a box, so that a point meets one of them wherever it lies in its own.
class BoxPyramid {
 public:
  /// Windows of the top level are 0.45 to 0.85 m wide where cells are 0.05 m.
  static constexpr int default_top_level = 3;

  /// `cell` and `epsilon` in m; in space where the motion is not planar. Throws ConfigError for a map of more
  /// than 2^30 cells.
  BoxPyramid(const Points& map_points, double cell, double epsilon, int top_level = default_top_level,
             int threads = 1, Motion motion = Motion::planar);

  [[nodiscard]] const CellFrame& frame() const { return frame_; }
  [[nodiscard]] int top_level() const { return static_cast<int>(levels_.size()) - 1; }
  /// What is counted in a box of level 0 is within epsilon + delta of the map at its middle, m.
  [[nodiscard]] double delta() const;
  [[nodiscard]] std::size_t memory_bytes() const;

  /// The boxes of layers that points which are in box 0 meet windows in, from the first to the last.
  struct BoxesOfLayers {
    int first, last;
  };
  [[nodiscard]] BoxesOfLayers boxes_of_layers(int level) const;

  /// For each of the 64 x 8 neighbouring boxes of a level, the first of which begins at (column, row), and
  /// all of which are the same box of layers, how many points can be in contact at most. Stops early where no
  /// box can reach `least`; the counts are then too small, but all below `least`. Returns how many points
  /// were looked at.
  std::size_t count(int level, const std::vector<CellPoints>& points, int column, int row, int layer,
                    std::size_t least, TileCounts& counts) const;

  /// For the same boxes of level 0, how many points are in contact at the middle of each, by the cells they
  /// lie in: one is in contact if its centre is within epsilon.
  void count_middles(const CellPoints& points, int column, int row, int layer, TileCounts& counts) const;

 private:
  CellFrame frame_;
  WindowBits middles_;
  std::vector<std::vector<WindowBits>> levels_;  ///< One for each group.
};

/// The pyramid over a map, built once per map and motion in the plane or in space.
[[nodiscard]] std::shared_ptr<const BoxPyramid> box_pyramid(const GlobalMap& map, double cell, double epsilon,
                                                            Motion motion, int threads);

}  // namespace glocal
