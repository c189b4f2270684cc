// Where a robot can drive in a grid, and how it gets from place to place there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/occupancy_grid.hpp"
#include "glocal/rng.hpp"
#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// Clear cells of a grid that can be reached from one another, over sides of clear cells.
class ClearRegion {
 public:
  /// The largest of all; of equal ones the first. `is_clear` has a mark for each cell, as clear_cells()
  /// gives them. Empty if no cell is clear.
  static ClearRegion largest(const OccupancyGrid& grid, std::vector<char> is_clear);
  /// The one that holds a place; empty if the place's cell is not clear.
  static ClearRegion around(const Position& place, const OccupancyGrid& grid, std::vector<char> is_clear);

  /// How many cells it has.
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] bool holds(const Position& place) const;
  /// The centre of one of its cells, each as likely as any other. Not for an empty region.
  [[nodiscard]] Position draw(Rng& rng) const;
  /// The places to go straight to from one place of the region to another, the last being `to`: a shortest
  /// way over the centres of cells (A*: Hart, Nilsson and Raphael, "A formal basis for the heuristic
  /// determination of minimum cost paths", IEEE Trans. SSC 1968), pulled tight. No part of it leaves the
  /// region.
  [[nodiscard]] std::vector<Position> way(const Position& from, const Position& to) const;

 private:
  ClearRegion(const OccupancyGrid& grid, std::vector<std::uint32_t> cells);

  [[nodiscard]] Position on_map(const Position& place) const;
  [[nodiscard]] bool holds_cell(int column, int row) const;
  [[nodiscard]] std::uint32_t cell_of(const Position& on_grid) const;
  [[nodiscard]] Position centre_of(std::uint32_t cell) const;
  [[nodiscard]] std::vector<std::uint32_t> cells_between(std::uint32_t from, std::uint32_t to) const;
  [[nodiscard]] bool is_straight_way(const Position& from, const Position& to) const;
  [[nodiscard]] std::vector<Position> shortened(const std::vector<Position>& way) const;
  [[nodiscard]] std::vector<Position> tightened(const std::vector<Position>& way) const;

  OccupancyGrid grid_;  ///< Without its cells.
  std::vector<std::uint32_t> cells_;
  std::vector<char> is_inside_;  ///< Of each cell of the grid.
};

}  // namespace glocal::simulation
