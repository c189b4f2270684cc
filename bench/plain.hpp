// The matcher's inner loops as one would write them first: one triple, one point at a time. Benchmarks
// compare the batched versions with them, and tests take them as an independent opinion.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/rng.hpp"
#include "matchers/common/triangle.hpp"

namespace glocal::plain {

/// Three points, each as likely as any other.
inline Triple draw(const Points& points, Rng& rng) {
  const auto n = static_cast<std::uint32_t>(points.size());
  return {rng.below(n), rng.below(n), rng.below(n)};
}

struct CanonicalTriangle {
  Triple triple;  ///< Counter-clockwise, the longest side from [0] to [1].
  Relation relation;
};

inline float squared_distance(const Points& points, std::uint32_t i, std::uint32_t j) {
  const float dx = points.x[i] - points.x[j];
  const float dy = points.y[i] - points.y[j];
  return dx * dx + dy * dy;
}

/// find_relations() for one triple; none if the rule excludes it.
inline std::optional<CanonicalTriangle> canonical_triangle(const Points& points, Triple triple,
                                                           const TriangleRule& rule) {
  auto& [i, j, k] = triple;
  if (i == j || j == k || k == i) return std::nullopt;
  std::array<float, 3> squares = {squared_distance(points, i, j), squared_distance(points, j, k),
                                  squared_distance(points, k, i)};
  const float longest = std::sqrt(std::max({squares[0], squares[1], squares[2]}));
  const float shortest = std::sqrt(std::min({squares[0], squares[1], squares[2]}));
  const float doubled_area = (points.x[j] - points.x[i]) * (points.y[k] - points.y[i]) -
                             (points.y[j] - points.y[i]) * (points.x[k] - points.x[i]);
  if (shortest < static_cast<float>(rule.min_side) || longest >= static_cast<float>(rule.max_side)) {
    return std::nullopt;
  }
  if (std::abs(doubled_area) < static_cast<float>(rule.min_height) * longest) return std::nullopt;

  if (doubled_area < 0.0F) {
    std::swap(j, k);
    std::swap(squares[0], squares[2]);
  }
  const auto first =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  CanonicalTriangle result{{}, 0};
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t side = (first + n) % 3;
    result.triple.at(n) = triple.at(side);
    const auto cell =
        static_cast<Relation>(std::sqrt(squares.at(side)) * static_cast<float>(1.0 / rule.cell));
    result.relation = result.relation << relation_side_bits | cell;
  }
  return result;
}

/// least_squares_motions() for one pair of canonical triples.
inline Transform least_squares_motion(const Points& from_points, const Triple& from, const Points& to_points,
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
  const float theta = std::atan2(cross, dot);
  const float c = std::cos(theta);
  const float s = std::sin(theta);
  return {c, s, to_x - (c * from_x - s * from_y), to_y - (s * from_x + c * from_y)};
}

/// The map's points dilated by epsilon, one byte per cell.
class ByteGrid {
 public:
  ByteGrid(const Points& points, double epsilon) : scale_(static_cast<float>(4.0 / epsilon)) {
    const auto [low_x, high_x] = std::minmax_element(points.x.begin(), points.x.end());
    const auto [low_y, high_y] = std::minmax_element(points.y.begin(), points.y.end());
    const auto margin = static_cast<float>(1.25 * epsilon);
    min_x_ = *low_x - margin;
    min_y_ = *low_y - margin;
    columns_ = static_cast<int>((*high_x + margin - min_x_) * scale_) + 1;
    rows_ = static_cast<int>((*high_y + margin - min_y_) * scale_) + 1;
    cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
    for (std::size_t i = 0; i < points.size(); ++i) dilate(points.x[i], points.y[i]);
  }

  [[nodiscard]] bool contact(const Point& p) const {
    const float column = (p.x - min_x_) * scale_;
    const float row = (p.y - min_y_) * scale_;
    if (!(column >= 0.0F && column < static_cast<float>(columns_) && row >= 0.0F &&
          row < static_cast<float>(rows_))) {
      return false;
    }
    return cells_[place(static_cast<int>(column), static_cast<int>(row))] != 0;
  }

  [[nodiscard]] std::size_t memory_bytes() const { return cells_.size(); }

 private:
  [[nodiscard]] std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void dilate(float x, float y) {
    const float column = (x - min_x_) * scale_;
    const float row = (y - min_y_) * scale_;
    for (int r = static_cast<int>(row) - 4; r <= static_cast<int>(row) + 4; ++r) {
      for (int c = static_cast<int>(column) - 4; c <= static_cast<int>(column) + 4; ++c) {
        if (std::hypot(static_cast<float>(c) + 0.5F - column, static_cast<float>(r) + 0.5F - row) <= 4.0F) {
          cells_[place(c, r)] = 1;
        }
      }
    }
  }

  float scale_;
  float min_x_ = 0.0F, min_y_ = 0.0F;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> cells_;
};

}  // namespace glocal::plain
