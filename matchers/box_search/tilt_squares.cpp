#include "matchers/box_search/tilt_squares.hpp"

#include <algorithm>

namespace glocal {
namespace {

double middle_of(std::size_t number, double side) {
  return side * (static_cast<double>(number) + 0.5) - TiltSquares::most_tilt;
}

}  // namespace

TiltSquares::TiltSquares(const std::function<bool(double reach)>& fit) : first_side_(2.0 * most_tilt) {
  std::size_t along_axis = 1;
  while (!fit(reach(0))) first_side_ = 2.0 * most_tilt / static_cast<double>(++along_axis);
  for (std::size_t row = 0; row < along_axis; ++row) {
    for (std::size_t column = 0; column < along_axis; ++column) {
      const Vector3 middle{middle_of(column, first_side_), middle_of(row, first_side_), 0.0};
      if (is_of_interest(middle, 0)) first_.push_back({column, row});
    }
  }
}

Vector3 TiltSquares::middle(std::size_t number, std::size_t quarters, int halvings) const {
  auto [column, row] = first_[number];
  for (int bit = 2 * (halvings - 1); bit >= 0; bit -= 2) {
    column = 2 * column + (quarters >> bit & 1);
    row = 2 * row + (quarters >> (bit + 1) & 1);
  }
  return {middle_of(column, side(halvings)), middle_of(row, side(halvings)), 0.0};
}

bool TiltSquares::is_of_interest(const Vector3& middle, int halvings) const {
  const double half_side = side(halvings) / 2.0;
  const auto nearest = [&](double coordinate) { return std::max(0.0, std::abs(coordinate) - half_side); };
  return std::hypot(nearest(middle.x()), nearest(middle.y())) <= most_tilt;
}

/// On the way from one tilt to another, each radian moves a point aside by its height, which changes by the
/// way. And where a tilt follows another one, they turn a little about the vertical, by half the larger tilt
/// for each radian (Jacobian of the exponential map).
double TiltSquares::aside(double reach, double height, double distance) {
  return reach * (height + 0.5 * (reach + largest(reach)) * distance);
}

}  // namespace glocal
