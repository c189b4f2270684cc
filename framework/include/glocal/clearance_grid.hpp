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
/// itself), up to 255: so far a ray may go without looking.
class ClearanceGrid {
 public:
  explicit ClearanceGrid(const OccupancyGrid& grid);

  /// The first occupied cell on the way between two points (m, in the map's frame), but for the last `margin`
  /// (m) of it: how far that is from the first point (m), none if there is no such cell. It is looked at
  /// every half cell. What lies beyond the grid is not occupied: a map without a grid blocks nothing.
  [[nodiscard]] std::optional<double> first_occupied(const Point& from, const Point& to, double margin) const;

  /// Whether there is one.
  [[nodiscard]] bool is_blocked(const Point& from, const Point& to, double margin) const {
    return first_occupied(from, to, margin).has_value();
  }
  /// Whether there is one on the way to each of the ends, once moved: 1, or else 0. What `blocked` had is
  /// lost.
  void find_blocked(const Point& from, const Points& ends, const Transform& map_from_ends, double margin,
                    std::vector<std::uint8_t>& blocked) const;

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }

  Transform grid_from_map_;
  float resolution_;
  int width_, height_;
  std::vector<std::uint8_t> clearance_;  ///< And three more, as ClearanceView asks for.
};

/// That of a map, shared by all who ask for it.
[[nodiscard]] std::shared_ptr<const ClearanceGrid> clearance_grid(const GlobalMap& map);

}  // namespace glocal
