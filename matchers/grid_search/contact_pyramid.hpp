// How many points of a local map can be in contact, at most, over whole blocks of translations.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/motion.hpp"
#include "glocal/points.hpp"
#include "matchers/grid_search/window_bits.hpp"

namespace glocal {

/// Square cells over a map, or cubic ones in space, and wherever a point can be in contact with it.
struct CellFrame {
  double cell = 0.0;  ///< m
  /// Outer corner of cell (0, 0, 0) in the map's frame, m.
  double min_x = 0.0, min_y = 0.0, min_z = 0.0;
  int columns = 0, rows = 0, layers = 1;
  bool in_space = false;  ///< In the plane heights do not count, and there is one layer.
};

/// Throws ConfigError where the cells of a search (m) are larger than epsilon (m): poses between them would
/// be missed.
void check_cell(double cell, double epsilon);

/// All cells within `epsilon` (m) of a point of the map, in the plane or, where the motion is not planar, in
/// space. Throws ConfigError where they are too many for a grid (1 GiB).
[[nodiscard]] CellFrame cell_frame(const Points& map_points, double cell, double epsilon,
                                   Motion motion = Motion::planar);

/// Marks the cells of a frame that are within `epsilon` (m) of a point of the map: by their centres, or, with
/// `anywhere`, by the nearest of their places. Windows of one cell, of which so many more begin before the
/// first column, row and, in space, layer.
[[nodiscard]] Windows cells_near(const Points& map_points, const CellFrame& frame, double epsilon,
                                 bool anywhere, int before);
/// The same of one layer of the frame, which is layer 0 of the windows, with none before it.
[[nodiscard]] Windows layer_near(const Points& map_points, const CellFrame& frame, double epsilon,
                                 bool anywhere, int layer);

/// Which cells of a map are in contact, and for each level l the sliding-window maximum of that: whether any
/// cell of the 2^l x 2^l cells from a cell on is. A node of level l stands for 2^l x 2^l translations; each
/// point meets their cells in one such window, wherever the window begins, so the number of windows in
/// contact bounds what any of the translations reaches (Olson 2015; Hess et al. 2016). A maximum over aligned
/// blocks would be no bound: a window lies across up to four of them.
/// In space windows are cubes of 2^l cells.
class ContactPyramid {
 public:
  /// Nodes of the top level are 0.8 m wide where cells are 0.05 m: larger ones bound nothing indoors.
  static constexpr int default_top_level = 4;

  /// A cell (of side `cell`, m) is in contact if its centre is within `epsilon` (m) of a point in the plane;
  /// in space where the motion is not planar. Throws ConfigError if it would need more than 1 GiB.
  ContactPyramid(const Points& map_points, double cell, double epsilon, int top_level = default_top_level,
                 Motion motion = Motion::planar);

  /// All cells in contact lie in it.
  [[nodiscard]] const CellFrame& frame() const { return frame_; }
  [[nodiscard]] int top_level() const { return static_cast<int>(levels_.size()) - 1; }
  [[nodiscard]] std::size_t memory_bytes() const;

  /// For each node of a tile of level l, how many of the points are in contact after any of the node's
  /// translations at most, and exactly how many on level 0. Node (i, k) of the tile stands for the
  /// translations by [column + i * 2^l, column + (i + 1) * 2^l) cells and rows likewise. Stops early where no
  /// node can reach `least`; the counts are then too small, but all below `least`. Returns how many points
  /// were looked at. At most TileCounts::most_points. In space, all nodes of a tile stand for the
  /// translations by [layer, layer + 2^l) layers.
  std::size_t count(int level, const CellPoints& points, int column, int row, std::size_t least,
                    TileCounts& counts, int layer = 0) const;

 private:
  CellFrame frame_;
  std::vector<WindowBits> levels_;
};

/// The pyramid over a map, built once per map.
[[nodiscard]] std::shared_ptr<const ContactPyramid> contact_pyramid(const GlobalMap& map, double cell,
                                                                    double epsilon,
                                                                    Motion motion = Motion::planar);

}  // namespace glocal
