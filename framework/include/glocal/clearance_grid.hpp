// How far a ray may go through a map without meeting anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/occupancy_grid.hpp"
#include "glocal/points.hpp"

namespace glocal {

/// For each cell of a grid, how many rows or columns away the nearest occupied one is (0: it is occupied
/// itself), up to 255: so far a ray may go without looking. From a cell to its neighbour that changes by one
/// at most, so that a block of 4 x 4 cells needs its least number and two bits for each cell.
class ClearanceGrid {
 public:
  /// Cells of a block along either axis.
  static constexpr unsigned block_shift = 2;
  static constexpr int block_side = 1 << block_shift;
  /// The least number of a block, then the two bits of each of its cells, row by row.
  static constexpr std::size_t block_bytes = 5;
  /// From twice as many on, a float has no half cells.
  static constexpr float farthest = 4'194'304.0F;

  /// The same for any number of threads.
  explicit ClearanceGrid(const OccupancyGrid& grid, int threads = 1);

  /// The first occupied cell on the way between two points (m, in the map's frame), but for the last `margin`
  /// (m) of it: how far that is from the first point (m), none if there is no such cell. It is looked at
  /// every half cell. What lies beyond the grid is not occupied: a map without a grid blocks nothing. Nor
  /// does what is farther than `farthest` cells.
  [[nodiscard]] std::optional<double> first_occupied(const Point& from, const Point& to, double margin) const;

  /// Whether there is one.
  [[nodiscard]] bool is_blocked(const Point& from, const Point& to, double margin) const {
    return first_occupied(from, to, margin).has_value();
  }
  /// Whether there is one on the way to each of the ends, once moved: 1, or else 0. What `blocked` had is
  /// lost.
  void find_blocked(const Point& from, const Points& ends, const Transform& map_from_ends, double margin,
                    std::vector<std::uint8_t>& blocked) const;

  [[nodiscard]] std::size_t memory_bytes() const { return blocks_.size(); }

 private:
  /// What is read for a block at once.
  using Word = std::uint64_t;

  /// Where that of a cell begins.
  [[nodiscard]] std::size_t block(int column, int row) const {
    return block_bytes * (static_cast<std::size_t>(row >> block_shift) * block_columns_ +
                          static_cast<std::size_t>(column >> block_shift));
  }
  [[nodiscard]] int clearance(int column, int row) const;
  /// Packs rows of numbers, one byte each, of which the first one has this number.
  void pack(const std::uint8_t* numbers, std::size_t stride, int first_row, int end_row);

  Transform grid_from_map_;
  float resolution_;
  int width_, height_;
  std::size_t block_columns_;
  std::vector<std::uint8_t> blocks_;  ///< And a few bytes behind the last.
};

/// That of a map, shared by all who ask for it.
[[nodiscard]] std::shared_ptr<const ClearanceGrid> clearance_grid(const GlobalMap& map, int threads = 1);

}  // namespace glocal
