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
  std::array<float, 3> squares = {squared_distance(points, i, j), squared_distance(points, j, k),
                                  squared_distance(points, k, i)};
  // Most triples of a large map end here, so this comes first.
  const float longest_square = std::max({squares[0], squares[1], squares[2]});
  const float shortest_square = std::min({squares[0], squares[1], squares[2]});
  const auto min_side = static_cast<float>(rule.min_side);
  const auto max_side = static_cast<float>(rule.max_side);
  if (!(shortest_square >= min_side * min_side && longest_square < max_side * max_side)) return std::nullopt;
  const float doubled_area = (points.x[j] - points.x[i]) * (points.y[k] - points.y[i]) -
                             (points.y[j] - points.y[i]) * (points.x[k] - points.x[i]);
  const auto min_height = static_cast<float>(rule.min_height);
  if (!(doubled_area * doubled_area >= min_height * min_height * longest_square)) return std::nullopt;

  if (doubled_area < 0.0F) {
    std::swap(j, k);
    std::swap(squares[0], squares[2]);
  }
  const std::size_t first = squares[0] == longest_square ? 0 : squares[1] == longest_square ? 1 : 2;
  const std::size_t second = (first + 1) % 3;
  const std::size_t third = (first + 2) % 3;
  const auto cells_per_metre = static_cast<float>(1.0 / rule.cell);
  const auto quantised = [&](std::size_t side) {
    return static_cast<Relation>(std::sqrt(squares.at(side)) * cells_per_metre);
  };
  const Relation relation = quantised(first) << (2 * relation_side_bits) |
                            quantised(second) << relation_side_bits | quantised(third);
  return CanonicalTriangle{{triple.at(first), triple.at(second), triple.at(third)}, relation};
}

Transform least_squares_motion(const Points& from_points, const Triple& from, const Points& to_points,
                               const Triple& to) {
  const auto mean = [](const std::vector<float>& values, const Triple& t) {
    return (values[t[0]] + values[t[1]] + values[t[2]]) / 3.0F;
  };
  const float from_x = mean(from_points.x, from);
  const float from_y = mean(from_points.y, from);
  const float to_x = mean(to_points.x, to);
  const float to_y = mean(to_points.y, to);
  float dot = 0.0F;
  float cross = 0.0F;
  for (std::size_t i = 0; i < 3; ++i) {
    const float ax = from_points.x[from[i]] - from_x;
    const float ay = from_points.y[from[i]] - from_y;
    const float bx = to_points.x[to[i]] - to_x;
    const float by = to_points.y[to[i]] - to_y;
    dot += ax * bx + ay * by;
    cross += ax * by - ay * bx;
  }
  // The optimal rotation turns by atan2(cross, dot); its cosine and sine need no trigonometry.
  const float norm = std::sqrt(dot * dot + cross * cross);
  const float c = norm > 0.0F ? dot / norm : 1.0F;
  const float s = norm > 0.0F ? cross / norm : 0.0F;
  return {c, s, to_x - (c * from_x - s * from_y), to_y - (s * from_x + c * from_y)};
}

}  // namespace glocal
