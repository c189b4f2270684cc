#include "matchers/grid_search/pose_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glocal {

double middle_of(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return 0.5 * (double{*low} + double{*high});
}

PoseGrid::PoseGrid(const Points& points, double cell, double min_rotation_step)
    : points_(points), cell_(cell), middle_x_(middle_of(points.x)), middle_y_(middle_of(points.y)) {
  constexpr double max_rotation_step = 0.1;
  double radius = 0.0;
  layers_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    radius = std::max(radius, std::hypot(points.x[i] - middle_x_, points.y[i] - middle_y_));
    layers_.push_back(static_cast<std::int32_t>(std::floor(points.z[i] / cell)));
  }
  const double step = std::min(max_rotation_step, std::max(min_rotation_step, cell / radius));
  rotations_ = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / step));
}

double PoseGrid::angle(std::size_t rotation) const {
  return 2.0 * std::numbers::pi * static_cast<double>(rotation) / static_cast<double>(rotations_);
}

CellPoints PoseGrid::cells(std::size_t rotation) const {
  const double c = std::cos(angle(rotation));
  const double s = std::sin(angle(rotation));
  const auto cell_of = [&](double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate / cell_));
  };
  CellPoints cells;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double x = points_.x[i] - middle_x_;
    const double y = points_.y[i] - middle_y_;
    cells.push_back(cell_of(c * x - s * y), cell_of(s * x + c * y), layers_[i]);
  }
  return cells;
}

Pose2 PoseGrid::pose(std::size_t rotation, int column, int row, double min_x, double min_y) const {
  const Pose2 moved{min_x + cell_ * column, min_y + cell_ * row, angle(rotation)};
  return moved * Pose2{-middle_x_, -middle_y_, 0.0};
}

Translations translations(const CellPoints& points, const CellFrame& frame) {
  const auto columns = points.columns();
  const auto rows = points.rows();
  const auto [left, right] = std::minmax_element(columns.begin(), columns.end());
  const auto [low, high] = std::minmax_element(rows.begin(), rows.end());
  return {-*right, frame.columns - 1 - *left, -*high, frame.rows - 1 - *low};
}

AllowedTranslations::AllowedTranslations(const PoseGate& gate, const Pose2& map_from_local, double cell)
    : map_from_start_(map_from_local * seen_from_above(gate.local_from_start())),
      cell_(cell),
      region_(gate.prior().region),
      none_(!Prior{.region = {}, .heading = gate.prior().heading}.allows(map_from_start_)) {}

bool AllowedTranslations::any(int column, int row, int columns, int rows) const {
  if (none_ || !region_.is_given()) return !none_;
  return region_.meets(map_from_start_.x + cell_ * column, map_from_start_.y + cell_ * row,
                       map_from_start_.x + cell_ * (column + columns - 1),
                       map_from_start_.y + cell_ * (row + rows - 1));
}

}  // namespace glocal
