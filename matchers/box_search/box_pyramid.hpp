// How many points of a local map can be in contact, at most, over boxes of poses.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/motion.hpp"
#include "glocal/points.hpp"
#include "matchers/box_search/cell_frame.hpp"
#include "matchers/box_search/window_bits.hpp"

namespace glocal {

/// Windows over the cells of a map in contact: for each level those that a point can meet, turned and moved
/// by any pose of a box. A point whose window has no cell in contact is in contact at no pose of the box, so
/// the number of the others bounds what any of its poses reaches (Olson 2015; Hess et al. 2016). Windows
/// begin anywhere: a maximum over aligned blocks would be no bound, since a window lies across up to four of
/// them.
class BoxPyramid {
 public:
  /// Whose poses are in its boxes (pose_boxes.hpp).
  enum class Of { pose_grid, all_poses };

  /// Boxes of the top level of a grid, and of all poses in space, are 0.8 m wide where cells are 0.05 m, and
  /// of all poses of the plane half of that: larger ones bound nothing indoors.
  [[nodiscard]] static constexpr int default_top_level(Of of, Motion motion = Motion::planar) {
    return of == Of::pose_grid || motion != Motion::planar ? 4 : 3;
  }

  /// `cell` and `epsilon` in m; in space where the motion is not planar. A cell is in contact if it is within
  /// epsilon of a point of the map: for a grid by its centre, for all poses by the nearest of its places.
  /// Throws ConfigError for a map of more than 2^30 cells.
  BoxPyramid(Of of, const Points& map_points, double cell, double epsilon, int top_level, int threads = 1,
             Motion motion = Motion::planar);

  [[nodiscard]] Of of() const { return of_; }
  [[nodiscard]] Motion motion() const { return motion_; }
  /// All cells in contact lie in it.
  [[nodiscard]] const CellFrame& frame() const { return frame_; }
  [[nodiscard]] int top_level() const { return static_cast<int>(levels_.size()) - 1; }
  /// What is counted in a box of level 0 is within epsilon + delta of the map at its middle, m. Of all poses.
  [[nodiscard]] double delta() const;
  [[nodiscard]] std::size_t memory_bytes() const;

  /// For each of the 64 x 8 neighbouring boxes of a level, the first of which begins at (column, row), and
  /// all of which have the same layers, from `layer` on, how many points can be in contact at most; of a
  /// grid's level 0, how many are. `points` are PoseBoxes::cells, or at the top level
  /// AllPoses::cluster_cells. Stops early where no box can reach `least`; the counts are then too small, but
  /// all below `least`. Returns how many points were looked at. At most TileCounts::most_points.
  std::size_t count(int level, const std::vector<CellPoints>& points, int column, int row, int layer,
                    std::size_t least, TileCounts& counts) const;

  /// For the same boxes of level 0 of all poses, how many points are in contact at the middle of each, by the
  /// cells they lie in: one is in contact if its centre is within epsilon.
  void count_middles(const CellPoints& points, int column, int row, int layer, TileCounts& counts) const;

 private:
  struct Level {
    int step;                      ///< Windows begin at multiples of so many layers.
    std::vector<WindowBits> bits;  ///< One for each group of points.
  };
  Of of_;
  Motion motion_;
  CellFrame frame_;
  std::vector<WindowBits> middles_;  ///< None, or one.
  std::vector<Level> levels_;
};

/// The pyramid over a map, built once per map and motion in the plane or in space. Throws ConfigError where
/// cells are larger than epsilon, or too many.
[[nodiscard]] std::shared_ptr<const BoxPyramid> box_pyramid(BoxPyramid::Of of, const GlobalMap& map,
                                                            double cell, double epsilon, Motion motion,
                                                            int threads);

}  // namespace glocal
