#include "sources/simulation/near_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "sources/grid_ray.hpp"

namespace glocal::simulation {
namespace {

constexpr double least_side = 2.5;  // m
constexpr double most_cells_a_side = 512.0;
constexpr int most_cells_a_shape = 256;
/// m; more than rounding puts a shape or a ray beside its cell.
constexpr double hair = 1e-6;

void add(Bounds& bounds, const Segment& segment) {
  bounds.add(segment.from, hair);
  bounds.add(segment.to, hair);
}

void add(Bounds& bounds, const Circle& circle) {
  bounds.add(circle.centre, circle.radius + hair);
}

void add(Bounds& bounds, const Top& top) {
  for (const Position& corner : top.corners) bounds.add(corner, hair);
}

template <class Visit>
void visit_each(const Shapes& shapes, Visit visit) {
  for (const Segment& segment : shapes.segments) visit(segment, &Shapes::segments);
  for (const Circle& circle : shapes.circles) visit(circle, &Shapes::circles);
  for (const Top& top : shapes.tops) visit(top, &Shapes::tops);
}

}  // namespace

NearShapes::NearShapes(const Shapes& shapes) {
  Bounds all;
  visit_each(shapes, [&](const auto& shape, auto /*list*/) { add(all, shape); });
  if (all.low[0] > all.high[0]) all.low = all.high = {};
  low_ = all.low;
  high_ = all.high;
  const Position extent{high_[0] - low_[0], high_[1] - low_[1]};
  side_ = std::max(least_side, std::max(extent[0], extent[1]) / most_cells_a_side);
  for (std::size_t axis = 0; axis < extent.size(); ++axis)
    numbers_[axis] = static_cast<int>(extent[axis] / side_) + 1;
  cells_.resize(static_cast<std::size_t>(numbers_[0]) * static_cast<std::size_t>(numbers_[1]));
  visit_each(shapes, [&](const auto& shape, auto list) { sort_in(shape, list); });
}

double NearShapes::ray_distance(const Position& origin, const Position& direction, double reach) const {
  return nearest_along(origin, direction, reach, [&](const Shapes& shapes) {
    return simulation::ray_distance(shapes, origin, direction);
  });
}

double NearShapes::ray_distance_in_space(const Vector3& origin, const Vector3& direction,
                                         double reach) const {
  return nearest_along(
      {origin.x(), origin.y()}, {direction.x(), direction.y()}, reach,
      [&](const Shapes& shapes) { return simulation::ray_distance_in_space(shapes, origin, direction); });
}

/// `level`: the way seen from above for 1 m along the ray, m.
template <class DistanceTo>
double NearShapes::nearest_along(const Position& origin, const Position& level, double reach,
                                 DistanceTo distance_to) const {
  // No shape is beyond the farthest corner.
  const auto farthest = [&](std::size_t axis) {
    return std::max(std::abs(origin[axis] - low_[axis]), std::abs(high_[axis] - origin[axis]));
  };
  const double run = std::hypot(level[0], level[1]);
  const double length = run > 0.0 ? std::min(reach, std::hypot(farthest(0), farthest(1)) / run) : 0.0;
  const Position from{in_cells(0, origin[0]), in_cells(1, origin[1])};
  const Position end{in_cells(0, origin[0] + length * level[0]), in_cells(1, origin[1] + length * level[1])};
  double nearest = distance_to(wide_);
  bool is_found = false;
  visit_cells_before_end(from[0], from[1], end[0], end[1], [&](int column, int row, double share) {
    is_found = share * length > nearest + hair;
    if (!is_found) nearest = std::min(nearest, distance_to(shapes_in(column, row)));
    return !is_found;
  });
  if (is_found) return nearest;
  const auto [column, row] = end;
  return std::min(nearest, distance_to(shapes_in(static_cast<int>(std::floor(column)),
                                                 static_cast<int>(std::floor(row)))));
}

template <class Shape>
void NearShapes::sort_in(const Shape& shape, std::vector<Shape> Shapes::*list) {
  Bounds bounds;
  add(bounds, shape);
  const auto cell_at = [&](std::size_t axis, double at) {
    return std::clamp(static_cast<int>(in_cells(axis, at)), 0, numbers_[axis] - 1);
  };
  const int first_column = cell_at(0, bounds.low[0]), last_column = cell_at(0, bounds.high[0]);
  const int first_row = cell_at(1, bounds.low[1]), last_row = cell_at(1, bounds.high[1]);
  if ((last_column - first_column + 1) * (last_row - first_row + 1) > most_cells_a_shape)
    return (wide_.*list).push_back(shape);
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column)
      (cells_[index(column, row)].*list).push_back(shape);
  }
}

const Shapes& NearShapes::shapes_in(int column, int row) const {
  static const Shapes nothing;
  if (column < 0 || row < 0 || column >= numbers_[0] || row >= numbers_[1]) return nothing;
  return cells_[index(column, row)];
}

}  // namespace glocal::simulation
