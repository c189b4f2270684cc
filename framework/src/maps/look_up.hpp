// The inner loops of DistanceField, CellsUnder and ClearanceGrid, for many points at a time. They are
// compiled for each instruction set and chosen when the program runs; answers are the same for all.
#pragma once

#include <cstdint>
#include <span>

#include "glocal/clearance_grid.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/occupancy_grid.hpp"
#include "glocal/points.hpp"

namespace glocal {

/// What a DistanceField has. A look-up may read two bytes behind the last cell.
struct FieldView {
  const std::uint8_t* cells;
  const std::uint32_t* tiles;
  float min_x, min_y, scale, step, reach;
  int columns, rows, tile_columns;
};

/// DistanceField::at() of all points, once moved.
void look_up(const FieldView& field, const Points& points, const Transform& map_from_points,
             FieldValues& values);

/// CellsUnder::find(), by a scale in cells per metre.
void find_cells(const OccupancyGrid& grid, float scale, const Points& points,
                const Transform& grid_from_points, std::span<Cell> cells);

/// What a ClearanceGrid has.
struct ClearanceView {
  const std::uint8_t* blocks;
  std::int32_t block_columns;
  int width, height;
  float resolution;
};

/// How far behind the last column (or row) something is, or before the first one, then negative; 0 within.
inline float outside(float at, int size) {
  const auto end = static_cast<float>(size);
  return at < 0.0F ? at : (at >= end ? at - end : 0.0F);
}

/// ClearanceGrid::find_blocked(), from a place in the grid's frame.
void find_blocked(const ClearanceView& clearance, const Point& from, const Points& ends,
                  const Transform& map_from_ends, const Transform& grid_from_map, float margin,
                  std::span<std::uint8_t> blocked);

}  // namespace glocal
