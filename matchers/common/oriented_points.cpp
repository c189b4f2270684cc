#include "matchers/common/oriented_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "glocal/parallel.hpp"

namespace glocal {
namespace {

constexpr auto pi = static_cast<float>(std::numbers::pi);

/// Points in square cells, for looking at neighbours. A few bytes for each point: a large map has millions.
class Cells {
 public:
  Cells(const Points& points, double side) : points_(points), scale_(1.0 / side) {
    struct Place {
      std::int32_t row, column;
      std::uint32_t point;
    };
    std::vector<Place> places(points.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      places[i] = {number(points.y[i]), number(points.x[i]), static_cast<std::uint32_t>(i)};
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return std::tie(a.row, a.column, a.point) < std::tie(b.row, b.column, b.point);
    });
    members_.reserve(places.size());
    for (const Place& place : places) {
      if (rows_.empty() || rows_.back().row != place.row)
        rows_.push_back({place.row, static_cast<std::uint32_t>(cells_.size())});
      const bool is_new = rows_.back().begin == cells_.size() || cells_.back().column != place.column;
      if (is_new) cells_.push_back({place.column, static_cast<std::uint32_t>(members_.size())});
      members_.push_back(place.point);
    }
    first_met_.resize(cells_.size());
    std::iota(first_met_.begin(), first_met_.end(), 0U);
    std::sort(first_met_.begin(), first_met_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return members_[cells_[a].begin] < members_[cells_[b].begin];
    });
  }

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  /// The points of a cell; cells have the order in which they were first met.
  [[nodiscard]] std::span<const std::uint32_t> members(std::size_t i) const { return in_cell(first_met_[i]); }

  /// Calls visit(x, y) for all points within a radius, which is at most twice a cell's side.
  template <class Visit>
  void near(float x, float y, double radius, Visit visit) const {
    const auto squared = static_cast<float>(radius * radius);
    const std::int32_t middle_row = number(y);
    const std::int32_t left = number(x) - 2;
    const std::int32_t right = number(x) + 2;
    auto row = std::lower_bound(rows_.begin(), rows_.end(), middle_row - 2,
                                [](const Row& r, std::int32_t wanted) { return r.row < wanted; });
    for (; row != rows_.end() && row->row <= middle_row + 2; ++row) {
      const auto begin = cells_.begin() + row->begin;
      const auto end = row + 1 == rows_.end() ? cells_.end() : cells_.begin() + (row + 1)->begin;
      auto cell = std::lower_bound(begin, end, left,
                                   [](const Cell& c, std::int32_t wanted) { return c.column < wanted; });
      for (; cell != end && cell->column <= right; ++cell) {
        for (const std::uint32_t i : in_cell(static_cast<std::size_t>(cell - cells_.begin()))) {
          const float dx = points_.x[i] - x;
          const float dy = points_.y[i] - y;
          if (dx * dx + dy * dy <= squared) visit(points_.x[i], points_.y[i]);
        }
      }
    }
  }

 private:
  /// Of a row, its first cell; of a cell, its first member.
  struct Row {
    std::int32_t row;
    std::uint32_t begin;
  };
  struct Cell {
    std::int32_t column;
    std::uint32_t begin;
  };

  [[nodiscard]] std::int32_t number(float v) const {
    return static_cast<std::int32_t>(std::floor(v * scale_));
  }
  [[nodiscard]] std::span<const std::uint32_t> in_cell(std::size_t cell) const {
    const std::size_t end = cell + 1 == cells_.size() ? members_.size() : cells_[cell + 1].begin;
    return std::span(members_).subspan(cells_[cell].begin, end - cells_[cell].begin);
  }

  const Points& points_;
  double scale_;
  std::vector<Row> rows_;
  std::vector<Cell> cells_;             ///< Row by row, by rising column.
  std::vector<std::uint32_t> members_;  ///< Cell by cell.
  std::vector<std::uint32_t> first_met_;
};

/// A straight line, with how far its points lie from it and along it (standard deviations, m).
struct Line {
  double x = 0.0, y = 0.0;  ///< The middle of its points.
  double direction = 0.0;   ///< rad
  double across = 0.0, along = 0.0;
  std::size_t size = 0;
};

/// The principal axis of those points that are within `reach` of a line.
Line fitted_line(const std::vector<std::pair<float, float>>& points, const Line& line, double reach) {
  const double c = std::cos(line.direction);
  const double s = std::sin(line.direction);
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  Line fit;
  for (const auto& [x, y] : points) {
    const double dx = x - line.x;
    const double dy = y - line.y;
    if (std::abs(c * dy - s * dx) > reach) continue;
    ++fit.size;
    sx += dx;
    sy += dy;
    sxx += dx * dx;
    sxy += dx * dy;
    syy += dy * dy;
  }
  if (fit.size == 0) return fit;
  const auto n = static_cast<double>(fit.size);
  const double cxx = sxx / n - sx * sx / (n * n);
  const double cxy = sxy / n - sx * sy / (n * n);
  const double cyy = syy / n - sy * sy / (n * n);
  const double mean = (cxx + cyy) / 2.0;
  const double spread = std::hypot((cxx - cyy) / 2.0, cxy);
  fit.x = line.x + sx / n;
  fit.y = line.y + sy / n;
  fit.direction = 0.5 * std::atan2(2.0 * cxy, cxx - cyy);
  fit.across = std::sqrt(std::max(0.0, mean - spread));
  fit.along = std::sqrt(mean + spread);
  return fit;
}

struct Direction {
  double angle, cosine, sine;
};

/// So many that the best one is off by 5 degrees at most: 2 cm at 0.2 m.
const std::array<Direction, 18>& directions_of_lines() {
  static const auto directions = [] {
    std::array<Direction, 18> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double angle = std::numbers::pi * static_cast<double>(i) / static_cast<double>(all.size());
      all[i] = {angle, std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return directions;
}

/// The line through a point that most of its neighbours are near to (Torr and Zisserman 2000: truncated
/// squares, MSAC): at a corner or at a thin wall the others lie on another surface, and count alike wherever
/// they are.
Line best_line_through(float x, float y, const std::vector<std::pair<float, float>>& points, double reach) {
  Line best{.x = x, .y = y};
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [direction, c, s] : directions_of_lines()) {
    double cost = 0.0;
    for (const auto& [px, py] : points) {
      const double off = c * (py - y) - s * (px - x);
      cost += std::min(off * off, reach * reach);
    }
    if (cost >= least) continue;
    least = cost;
    best.direction = direction;
  }
  return best;
}

/// Angle of the normal, up to half a turn, by the principal components of the neighbours on one line with the
/// point; none where there is no line, or less than `fewest_on_line` of them are on it: clutter.
std::optional<float> normal_angle(const Cells& cells, float x, float y, const OrientedPointRule& rule) {
  constexpr std::size_t fewest = 3;
  constexpr double fewest_on_line = 0.45;
  std::vector<std::pair<float, float>> points;
  cells.near(x, y, rule.radius, [&](float px, float py) { points.emplace_back(px, py); });
  const double reach = rule.voxel_size / 2.0;
  Line line = best_line_through(x, y, points, reach);
  // Twice: the point itself may be at the edge of a rough wall.
  for (int i = 0; i < 2; ++i) line = fitted_line(points, line, reach);
  if (line.size < fewest) return std::nullopt;
  if (static_cast<double>(line.size) < fewest_on_line * static_cast<double>(points.size()))
    return std::nullopt;
  if (!(line.across < rule.max_roughness * line.along)) return std::nullopt;
  return static_cast<float>(line.direction + std::numbers::pi / 2.0);
}

float wrapped(float angle) {
  return angle > pi ? angle - 2.0F * pi : angle <= -pi ? angle + 2.0F * pi : angle;
}

/// The mean of a cell's points.
Point middle_of(const Points& points, std::span<const std::uint32_t> members) {
  float x = 0.0F;
  float y = 0.0F;
  for (const std::uint32_t i : members) {
    x += points.x[i];
    y += points.y[i];
  }
  return {x / static_cast<float>(members.size()), y / static_cast<float>(members.size()), 0.0F};
}

/// Where a normal has been looked for.
struct Surface {
  Point middle;
  std::optional<float> angle = {};
};

/// The middle of each cell, with its normal.
std::vector<Surface> surfaces_of(const Points& points, const OrientedPointRule& rule, int threads) {
  const Cells cells(points, rule.voxel_size);
  std::vector<Surface> surfaces(cells.size());
  constexpr std::size_t at_a_time = 1024;
  parallel_for(threads, (surfaces.size() + at_a_time - 1) / at_a_time, [&](std::size_t chunk) {
    const std::size_t end = std::min(surfaces.size(), (chunk + 1) * at_a_time);
    for (std::size_t i = chunk * at_a_time; i < end; ++i) {
      const Point middle = middle_of(points, cells.members(i));
      surfaces[i] = {middle, normal_angle(cells, middle.x, middle.y, rule)};
    }
  });
  return surfaces;
}

/// Whether there is a free cell a little way off in this direction, and not beyond another surface: the other
/// side of a thin wall.
bool is_free_side(const OccupancyGrid& grid, float x, float y, float angle) {
  constexpr double nearest = 0.1;
  constexpr double farthest = 0.31;
  if (grid.cells.empty()) return false;  // and has no resolution to go by
  bool left_own = false;
  for (double d = nearest; d < farthest; d += grid.resolution) {
    const Cell cell = grid.at(x + d * std::cos(angle), y + d * std::sin(angle));
    if (cell == Cell::free) return true;
    if (cell == Cell::unknown) left_own = true;
    if (cell == Cell::occupied && left_own) return false;
  }
  return false;
}

}  // namespace

OrientedPoints oriented_points_of(const GlobalMap& map, const OrientedPointRule& rule, int threads) {
  OrientedPoints result;
  const std::vector<Surface> surfaces = surfaces_of(map.points(), rule, threads);
  std::size_t with_normal = 0;
  for (const auto& [middle, angle] : surfaces) {
    if (!angle) continue;
    ++with_normal;
    const bool this_side = is_free_side(map.grid(), middle.x, middle.y, *angle);
    const bool other_side = is_free_side(map.grid(), middle.x, middle.y, *angle + pi);
    if (this_side || !other_side) result.add(middle.x, middle.y, wrapped(*angle));
    if (other_side || !this_side) result.add(middle.x, middle.y, wrapped(*angle + pi));
  }
  result.share = static_cast<double>(with_normal) / static_cast<double>(surfaces.size());
  return result;
}

OrientedPoints oriented_points_of(const LocalMap& local, const OrientedPointRule& rule) {
  OrientedPoints result;
  for (std::size_t i = 0; i < local.normals.size(); ++i) {
    const Point normal = local.normals[i];
    if (normal.x == 0.0F && normal.y == 0.0F) continue;
    result.add(local.points.x[i], local.points.y[i], std::atan2(normal.y, normal.x));
  }
  if (!local.normals.empty()) return result;
  for (const auto& [middle, angle] : surfaces_of(local.points, rule, 1)) {
    if (!angle) continue;
    result.add(middle.x, middle.y, wrapped(*angle));
    result.add(middle.x, middle.y, wrapped(*angle + pi));
  }
  return result;
}

Points downsampled_in_plane(const Points& points, double side) {
  const Cells cells(points, side);
  Points result;
  for (std::size_t i = 0; i < cells.size(); ++i) result.push_back(middle_of(points, cells.members(i)));
  return result;
}

}  // namespace glocal
