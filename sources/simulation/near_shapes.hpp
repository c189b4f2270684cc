// Shapes sorted by where they are.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// The shapes of a world of any size, of which a ray looks at those along its way only.
class NearShapes {
 public:
  explicit NearShapes(const Shapes& shapes);

  /// The same as among all shapes (shapes.hpp), up to `reach` (m); if nothing is so near, more than that.
  [[nodiscard]] double ray_distance(const Position& origin, const Position& direction, double reach) const;
  [[nodiscard]] double ray_distance_in_space(const Vector3& origin, const Vector3& direction,
                                             double reach) const;

 private:
  template <class DistanceTo>
  [[nodiscard]] double nearest_along(const Position& origin, const Position& level, double reach,
                                     DistanceTo distance_to) const;
  template <class Shape>
  void sort_in(const Shape& shape, std::vector<Shape> Shapes::*list);
  /// The cells of an axis, m from the lowest corner.
  [[nodiscard]] double in_cells(std::size_t axis, double at) const { return (at - low_[axis]) / side_; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(numbers_[0]) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] const Shapes& shapes_in(int column, int row) const;

  Position low_{}, high_{};       ///< Of what is around all shapes.
  double side_ = 0.0;             ///< Of a cell, m.
  std::array<int, 2> numbers_{};  ///< Of columns and rows.
  std::vector<Shapes> cells_;     ///< Row after row; a shape is in each cell that its bounds meet.
  Shapes wide_;                   ///< Those that would be in too many.
};

}  // namespace glocal::simulation
