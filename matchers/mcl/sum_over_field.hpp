// The inner loop of the likelihood field.
#pragma once

#include <cstddef>

#include "glocal/points.hpp"

namespace glocal::mcl {

/// A table of square cells, row by row; what lies outside counts as the nearest cell at its border.
struct FieldCells {
  float min_x, min_y;  ///< m
  float scale;         ///< Cells per metre.
  int columns, rows;
  const float* cells;
};

/// For each of the first `size` poses, the sum of the cells that the points fall into. `sums` has room for a
/// whole batch.
void sum_over_field(const FieldCells& field, const Points& points, const MotionBatch& map_from_points,
                    std::size_t size, float* sums);

}  // namespace glocal::mcl
