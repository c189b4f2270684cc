// The poses an exact search looks at: whole cells of translation, and rotations about a middle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/prior.hpp"
#include "matchers/grid_search/contact_pyramid.hpp"

namespace glocal {

/// Half way between the least and the largest.
[[nodiscard]] double middle_of(const std::vector<float>& values);

/// Poses of a local map. The points are turned about the middle of the rectangle they fill, by whole steps,
/// and moved by whole cells: once turned, each lies in the cell that its coordinates over the side of a cell,
/// rounded down, name, and translations keep it in the same place within its cell. So what cells the points
/// of a grid pose lie in is a matter of integers. In space, so it is with layers: heights do not change as
/// the points are turned.
class PoseGrid {
 public:
  /// `cell` in m. A rotation by one step moves the farthest point by one cell, but is not smaller than
  /// `min_rotation_step` (rad) and at most 0.1 rad. At least one point.
  PoseGrid(const Points& points, double cell, double min_rotation_step);

  [[nodiscard]] std::size_t rotations() const { return rotations_; }
  /// In [0, 2 pi), rad.
  [[nodiscard]] double angle(std::size_t rotation) const;
  /// The cells of the points, turned but not moved.
  [[nodiscard]] CellPoints cells(std::size_t rotation) const;
  /// target_from_points of a grid pose, where the target's cell (0, 0) begins at (min_x, min_y).
  [[nodiscard]] Pose2 pose(std::size_t rotation, int column, int row, double min_x, double min_y) const;

 private:
  const Points& points_;
  double cell_;
  double middle_x_, middle_y_;
  std::vector<std::int32_t> layers_;  ///< Of the points.
  std::size_t rotations_;
};

/// Translations by whole cells, from the first to the last.
struct Translations {
  int first_column, last_column;
  int first_row, last_row;
};

/// All that bring a point into a cell of the frame.
[[nodiscard]] Translations translations(const CellPoints& points, const CellFrame& frame);

/// Those translations of one rotation that a gate allows.
class AllowedTranslations {
 public:
  /// `map_from_local` before any translation; `cell`: what translations are multiples of (m).
  AllowedTranslations(const PoseGate& gate, const Pose2& map_from_local, double cell);

  /// Whether one of a rectangle of translations may be allowed; of a single one, whether it is.
  [[nodiscard]] bool any(int column, int row, int columns = 1, int rows = 1) const;

 private:
  Pose2 map_from_start_;  ///< Before any translation.
  double cell_;
  StartRegion region_;
  bool none_;  ///< Since the rotation is not allowed.
};

}  // namespace glocal
