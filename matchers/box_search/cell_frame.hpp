// Square cells over a map, by which exact searches count.
#pragma once

#include "glocal/motion.hpp"
#include "glocal/points.hpp"

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

}  // namespace glocal
