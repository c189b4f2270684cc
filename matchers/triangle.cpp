#include "matchers/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glocal {
namespace {

float squared_distance(const Points& points, std::uint32_t i, std::uint32_t j) {
  const float dx = points.x[i] - points.x[j];
  const float dy = points.y[i] - points.y[j];
  return dx * dx + dy * dy;
}

}  // namespace

std::optional<CanonicalTriangle> canonical_triangle(const Points& points, Triple triple,
                                                    const TriangleRule& rule) {
  auto& [i, j, k] = triple;
  const float doubled_area = (points.x[j] - points.x[i]) * (points.y[k] - points.y[i]) -
                             (points.y[j] - points.y[i]) * (points.x[k] - points.x[i]);
  if (doubled_area < 0.0F) std::swap(j, k);

  std::array<float, 3> squares = {squared_distance(points, i, j), squared_distance(points, j, k),
                                  squared_distance(points, k, i)};
  const auto longest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  std::rotate(triple.begin(), triple.begin() + longest, triple.end());
  std::rotate(squares.begin(), squares.begin() + longest, squares.end());

  const auto [a, b, c] = squares;
  const auto min_side = static_cast<float>(rule.min_side);
  const auto max_side = static_cast<float>(rule.max_side);
  const auto min_height = static_cast<float>(rule.min_height);
  if (!(std::min(b, c) >= min_side * min_side && a < max_side * max_side)) return std::nullopt;
  if (!(doubled_area * doubled_area >= min_height * min_height * a)) return std::nullopt;

  const auto cells_per_metre = static_cast<float>(1.0 / rule.cell);
  Relation relation = 0;
  for (const float square : squares) {
    relation = relation << relation_side_bits | static_cast<Relation>(std::sqrt(square) * cells_per_metre);
  }
  return CanonicalTriangle{triple, relation};
}

Pose2 least_squares_motion(const Points& from_points, const Triple& from, const Points& to_points,
                           const Triple& to) {
  double from_x = 0.0, from_y = 0.0, to_x = 0.0, to_y = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    from_x += from_points.x[from[i]] / 3.0;
    from_y += from_points.y[from[i]] / 3.0;
    to_x += to_points.x[to[i]] / 3.0;
    to_y += to_points.y[to[i]] / 3.0;
  }
  double dot = 0.0, cross = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double ax = from_points.x[from[i]] - from_x;
    const double ay = from_points.y[from[i]] - from_y;
    const double bx = to_points.x[to[i]] - to_x;
    const double by = to_points.y[to[i]] - to_y;
    dot += ax * bx + ay * by;
    cross += ax * by - ay * bx;
  }
  const double theta = std::atan2(cross, dot);
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  return {to_x - (c * from_x - s * from_y), to_y - (s * from_x + c * from_y), wrap_angle(theta)};
}

}  // namespace glocal
