#include "matchers/surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>

namespace glocal {
namespace {

constexpr auto pi = static_cast<float>(std::numbers::pi);

/// Points in square cells, for looking at neighbours.
class Cells {
 public:
  using Key = std::uint64_t;

  Cells(const Points& points, double side) : points_(points), scale_(1.0 / side) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [place, is_new] = cells_.try_emplace(key(points.x[i], points.y[i]), order_.size());
      if (is_new) order_.emplace_back();
      order_[place->second].push_back(static_cast<std::uint32_t>(i));
    }
  }

  /// The cells' points, in the order in which the cells were first met.
  [[nodiscard]] const std::vector<std::vector<std::uint32_t>>& all() const { return order_; }

  /// Calls visit(x, y) for all points within a radius, which is at most twice a cell's side.
  template <class Visit>
  void near(float x, float y, double radius, Visit visit) const {
    const auto squared = static_cast<float>(radius * radius);
    for (int row = -2; row <= 2; ++row) {
      for (int column = -2; column <= 2; ++column) {
        const auto cell =
            cells_.find(key(x + static_cast<float>(column / scale_), y + static_cast<float>(row / scale_)));
        if (cell == cells_.end()) continue;
        for (const std::uint32_t i : order_[cell->second]) {
          const float dx = points_.x[i] - x;
          const float dy = points_.y[i] - y;
          if (dx * dx + dy * dy <= squared) visit(points_.x[i], points_.y[i]);
        }
      }
    }
  }

 private:
  [[nodiscard]] Key key(float x, float y) const {
    const auto number = [&](float v) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(v * scale_)));
    };
    return Key{number(x)} << 32U | number(y);
  }

  const Points& points_;
  double scale_;
  std::unordered_map<Key, std::size_t> cells_;
  std::vector<std::vector<std::uint32_t>> order_;
};

/// Angle of the normal, up to half a turn, by the principal components of the neighbourhood; none where it
/// shows no line.
std::optional<float> normal_angle(const Cells& cells, float x, float y, const SurfaceRule& rule) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  cells.near(x, y, rule.radius, [&](float px, float py) {
    const double dx = px - x;
    const double dy = py - y;
    n += 1.0;
    sx += dx;
    sy += dy;
    sxx += dx * dx;
    sxy += dx * dy;
    syy += dy * dy;
  });
  constexpr double fewest = 3.0;
  if (n < fewest) return std::nullopt;
  const double cxx = sxx / n - sx * sx / (n * n);
  const double cxy = sxy / n - sx * sy / (n * n);
  const double cyy = syy / n - sy * sy / (n * n);
  const double mean = (cxx + cyy) / 2.0;
  const double spread = std::hypot((cxx - cyy) / 2.0, cxy);
  const double across = std::sqrt(std::max(0.0, mean - spread));
  const double along = std::sqrt(mean + spread);
  if (!(across < rule.max_roughness * along)) return std::nullopt;
  const double direction = 0.5 * std::atan2(2.0 * cxy, cxx - cyy);
  return static_cast<float>(direction + std::numbers::pi / 2.0);
}

float wrapped(float angle) {
  return angle > pi ? angle - 2.0F * pi : angle <= -pi ? angle + 2.0F * pi : angle;
}

/// One point for each cell: the mean of its points, with the normal found there.
template <class Add>
void for_each_thinned(const Points& points, const SurfaceRule& rule, Add add) {
  const Cells cells(points, rule.thinning);
  for (const auto& members : cells.all()) {
    float x = 0.0F;
    float y = 0.0F;
    for (const std::uint32_t i : members) {
      x += points.x[i];
      y += points.y[i];
    }
    x /= static_cast<float>(members.size());
    y /= static_cast<float>(members.size());
    if (const auto angle = normal_angle(cells, x, y, rule)) add(x, y, *angle);
  }
}

/// Whether there is a free cell a little way off in this direction.
bool is_free_side(const OccupancyGrid& grid, float x, float y, float angle) {
  constexpr double nearest = 0.1;
  constexpr double farthest = 0.31;
  for (double d = nearest; d < farthest; d += grid.resolution) {
    if (grid.at(x + d * std::cos(angle), y + d * std::sin(angle)) == Cell::free) return true;
  }
  return false;
}

}  // namespace

Surfaces surfaces_of(const GlobalMap& map, const SurfaceRule& rule) {
  Surfaces result;
  for_each_thinned(map.points(), rule, [&](float x, float y, float angle) {
    const bool this_side = is_free_side(map.grid(), x, y, angle);
    const bool other_side = is_free_side(map.grid(), x, y, angle + pi);
    if (this_side || !other_side) result.add(x, y, wrapped(angle));
    if (other_side || !this_side) result.add(x, y, wrapped(angle + pi));
  });
  return result;
}

Surfaces surfaces_of(const LocalMap& local, const SurfaceRule& rule) {
  Surfaces result;
  for (std::size_t i = 0; i < local.normals.size(); ++i) {
    const Point normal = local.normals[i];
    if (normal.x == 0.0F && normal.y == 0.0F) continue;
    result.add(local.points.x[i], local.points.y[i], std::atan2(normal.y, normal.x));
  }
  if (!local.normals.empty()) return result;
  for_each_thinned(local.points, rule, [&](float x, float y, float angle) {
    result.add(x, y, wrapped(angle));
    result.add(x, y, wrapped(angle + pi));
  });
  return result;
}

}  // namespace glocal
