// Shapes sorted by where they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// Segments and circles of a world of any size, of which a laser sees those around it.
class NearShapes {
 public:
  explicit NearShapes(const Shapes& shapes);

  /// All segments and circles with a part nearer to a place than `reach` (m), and some others, in the order
  /// in which they were given.
  [[nodiscard]] Shapes around(const Position& place, double reach) const;

 private:
  /// Columns or rows of cells that a part of an axis meets.
  struct CellRange {
    std::size_t first = 0;
    std::size_t last = 0;
  };

  [[nodiscard]] CellRange cells_from(std::size_t axis, double from, double to) const;
  void sort_in(std::uint32_t shape, const Position& low, const Position& high);

  Shapes shapes_;
  Position low_{};
  double side_ = 0.0;  ///< Of a cell, m.
  std::size_t columns_ = 0;
  /// Shapes by their indexes: segments, then circles.
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<std::uint32_t> wide_;  ///< Those that are in too many cells.
};

}  // namespace glocal::simulation
