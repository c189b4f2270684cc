#include "matchers/common/oriented_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "glocal/evenly.hpp"
#include "glocal/extent.hpp"
#include "glocal/parallel.hpp"

namespace glocal {
namespace {

constexpr auto pi = static_cast<float>(std::numbers::pi);

/// Of more squares an even share gives oriented points. So many hold all that an index of pairs has room for.
constexpr std::size_t most_surfaces = 3'000'000;

/// Points in square cells, for looking at neighbours. A few bytes for each point: a large map has millions.
class Cells {
 public:
  Cells(const Points& points, double side, int threads = 1) : points_(points), scale_(1.0 / side) {
    if (points.empty()) return;
    sort_members(threads);
    std::vector<bool> is_first(points.size());
    for_first_members([&](std::uint32_t point, std::size_t /*member*/) { is_first[point] = true; });
    const auto cells = static_cast<std::size_t>(std::ranges::count(is_first, true));
    cells_.reserve(cells);
    for_first_members([&](std::uint32_t point, std::size_t member) {
      const Place place = place_of(point);
      if (rows_.empty() || rows_.back().row != place.row)
        rows_.push_back({place.row, static_cast<std::uint32_t>(cells_.size())});
      cells_.push_back({place.column, static_cast<std::uint32_t>(member)});
    });
    first_met_.reserve(cells);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (is_first[i]) first_met_.push_back(i);
    }
  }

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  /// The points of a cell; cells have the order in which they were first met.
  [[nodiscard]] std::span<const std::uint32_t> members(std::size_t i) const {
    const Place place = place_of(first_met_[i]);
    const auto row = first_row_from(place.row);
    return in_cell(static_cast<std::size_t>(first_cell_from(row, place.column) - cells_.begin()));
  }

  /// Calls visit(x, y) for all points within a radius, which is at most twice a cell's side.
  template <class Visit>
  void near(float x, float y, double radius, Visit visit) const {
    const auto squared = static_cast<float>(radius * radius);
    const std::int32_t middle_row = number(y);
    const std::int32_t left = number(x) - 2;
    const std::int32_t right = number(x) + 2;
    for (auto row = first_row_from(middle_row - 2); row != rows_.end() && row->row <= middle_row + 2; ++row) {
      const auto end = end_of(row);
      auto cell = first_cell_from(row, left);
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
  struct Place {
    std::int32_t row, column;
    std::uint32_t point;
  };
  [[nodiscard]] Place place_of(std::uint32_t point) const {
    return {number(points_.y[point]), number(points_.x[point]), point};
  }

  /// Row by row, then by column and number: first into buckets of some rows each, then each by itself. That
  /// takes no more memory than the members, and most maps have their points nearly in this order.
  void sort_members(int threads) {
    const Extent y = extent_of(points_.y);
    const std::int64_t first_row = number(y.low);
    const auto n = static_cast<std::int64_t>(points_.size());
    const std::int64_t rows_of_bucket = (number(y.high) - first_row) / n + 1;
    const auto bucket_of = [&](std::size_t point) {
      return static_cast<std::size_t>((number(points_.y[point]) - first_row) / rows_of_bucket);
    };
    std::vector<std::uint32_t> ends(static_cast<std::size_t>((number(y.high) - first_row) / rows_of_bucket) +
                                    2);
    for (std::size_t i = 0; i < points_.size(); ++i) ++ends[bucket_of(i) + 1];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    members_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i)
      members_[ends[bucket_of(i)]++] = static_cast<std::uint32_t>(i);
    // Each bucket now ends where the next one began.
    constexpr std::size_t at_a_time = 64;
    parallel_for(threads, ends.size() / at_a_time + 1, [&](std::size_t chunk) {
      std::vector<Place> places;
      for (std::size_t i = chunk * at_a_time; i < std::min(ends.size(), (chunk + 1) * at_a_time); ++i) {
        const auto begin = members_.begin() + (i == 0 ? 0 : ends[i - 1]);
        const auto end = members_.begin() + ends[i];
        places.clear();
        std::transform(begin, end, std::back_inserter(places),
                       [&](std::uint32_t point) { return place_of(point); });
        std::ranges::sort(places, {}, [](const Place& p) { return std::tie(p.row, p.column, p.point); });
        std::transform(places.begin(), places.end(), begin, [](const Place& place) { return place.point; });
      }
    });
  }

  /// Of a row, its first cell; of a cell, its first member.
  struct Row {
    std::int32_t row;
    std::uint32_t begin;
  };
  struct Cell {
    std::int32_t column;
    std::uint32_t begin;
  };

  /// Calls visit(point, its place among the members) for the first point of each cell.
  template <class Visit>
  void for_first_members(Visit visit) const {
    Place last{};
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const Place place = place_of(members_[i]);
      if (i == 0 || place.row != last.row || place.column != last.column) visit(members_[i], i);
      last = place;
    }
  }

  [[nodiscard]] std::vector<Row>::const_iterator first_row_from(std::int32_t wanted) const {
    return std::ranges::lower_bound(rows_, wanted, {}, &Row::row);
  }
  [[nodiscard]] std::vector<Cell>::const_iterator end_of(std::vector<Row>::const_iterator row) const {
    return row + 1 == rows_.end() ? cells_.end() : cells_.begin() + (row + 1)->begin;
  }
  [[nodiscard]] std::vector<Cell>::const_iterator first_cell_from(std::vector<Row>::const_iterator row,
                                                                  std::int32_t wanted) const {
    return std::ranges::lower_bound(cells_.begin() + row->begin, end_of(row), wanted, {}, &Cell::column);
  }

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
  std::vector<Cell> cells_;               ///< Row by row, by rising column.
  std::vector<std::uint32_t> members_;    ///< Cell by cell.
  std::vector<std::uint32_t> first_met_;  ///< The first point of each cell.
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

/// So many that the best one is off by 5 degrees at most: 2 cm at 0.2 m.
struct LineDirections {
  static constexpr std::size_t size = 18;

  std::array<double, size> angle, cosine, sine;
};

const LineDirections& directions_of_lines() {
  static const auto directions = [] {
    LineDirections all{};
    for (std::size_t i = 0; i < LineDirections::size; ++i) {
      all.angle[i] = std::numbers::pi * static_cast<double>(i) / static_cast<double>(LineDirections::size);
      all.cosine[i] = std::cos(all.angle[i]);
      all.sine[i] = std::sin(all.angle[i]);
    }
    return all;
  }();
  return directions;
}

/// The line through a point that most of its neighbours are near to (Torr and Zisserman 2000: truncated
/// squares, MSAC): at a corner or at a thin wall the others lie on another surface, and count alike wherever
/// they are.
Line best_line_through(float x, float y, const std::vector<std::pair<float, float>>& points, double reach) {
  const LineDirections& directions = directions_of_lines();
  const double most = reach * reach;
  std::array<double, LineDirections::size> costs{};
  for (const auto& [px, py] : points) {
    const double dx = px - x;
    const double dy = py - y;
    for (std::size_t i = 0; i < costs.size(); ++i) {  // a vector loop
      const double off = directions.cosine[i] * dy - directions.sine[i] * dx;
      costs[i] += std::min(off * off, most);
    }
  }
  const auto least = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  return {.x = x, .y = y, .direction = directions.angle[least]};
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
  bool is_free_there = false, is_free_behind = false;  ///< Where the normal points to, and on the other side.
};

/// The middle of each cell, with its normal, and what `look` finds out beyond that.
template <class Look>
std::vector<Surface> surfaces_of(const Points& points, const OrientedPointRule& rule, int threads,
                                 Look look) {
  const Cells cells(points, rule.voxel_size, threads);
  const std::vector<std::size_t> chosen = evenly_chosen(cells.size(), most_surfaces);
  std::vector<Surface> surfaces(chosen.size());
  constexpr std::size_t at_a_time = 1024;
  parallel_for(threads, (surfaces.size() + at_a_time - 1) / at_a_time, [&](std::size_t chunk) {
    const std::size_t end = std::min(surfaces.size(), (chunk + 1) * at_a_time);
    for (std::size_t i = chunk * at_a_time; i < end; ++i) {
      const Point middle = middle_of(points, cells.members(chosen[i]));
      surfaces[i] = {middle, normal_angle(cells, middle.x, middle.y, rule)};
      if (surfaces[i].angle) look(surfaces[i]);
    }
  });
  return surfaces;
}

/// Whether there is a free cell a little way off in this direction, and not beyond another surface: the other
/// side of a thin wall.
bool is_free_side(const OccupancyGrid& grid, const CellsAt& cells, float x, float y, float angle) {
  constexpr double nearest = 0.1;
  constexpr double farthest = 0.31;
  if (grid.cells.empty()) return false;  // and has no resolution to go by
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  bool left_own = false;
  for (double d = nearest; d < farthest; d += grid.resolution) {
    const Cell cell = cells(x + d * c, y + d * s);
    if (cell == Cell::free) return true;
    if (cell == Cell::unknown) left_own = true;
    if (cell == Cell::occupied && left_own) return false;
  }
  return false;
}

}  // namespace

OrientedPoints oriented_points_of(const GlobalMap& map, const OrientedPointRule& rule, int threads) {
  OrientedPoints result;
  const CellsAt cells(map.grid());
  const auto look_at_sides = [&](Surface& surface) {
    const auto is_free = [&](float angle) {
      return is_free_side(map.grid(), cells, surface.middle.x, surface.middle.y, angle);
    };
    surface.is_free_there = is_free(*surface.angle);
    surface.is_free_behind = is_free(*surface.angle + pi);
  };
  const std::vector<Surface> surfaces = surfaces_of(map.points(), rule, threads, look_at_sides);
  std::size_t with_normal = 0;
  for (const auto& [middle, angle, this_side, other_side] : surfaces) {
    if (!angle) continue;
    ++with_normal;
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
  const auto add = [&](const Surface& surface) {
    result.add(surface.middle.x, surface.middle.y, wrapped(*surface.angle));
    result.add(surface.middle.x, surface.middle.y, wrapped(*surface.angle + pi));
  };
  surfaces_of(local.points, rule, 1, add);
  return result;
}

Points downsampled_in_plane(const Points& points, double side) {
  const Cells cells(points, side);
  Points result;
  for (std::size_t i = 0; i < cells.size(); ++i) result.push_back(middle_of(points, cells.members(i)));
  return result;
}

}  // namespace glocal
