#include "matchers/grid_search/box_pyramid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "glocal/parallel.hpp"
#include "matchers/common/squares.hpp"
#include "matchers/grid_search/pose_grid.hpp"

namespace glocal {
namespace {

/// Says of each window along one axis, from `ahead` - 1 before the first cell on, whether one of the cells
/// from `behind` before to `ahead` - 1 after its own is marked: calls mark(window) after entered(cell) for
/// all cells up to its last one.
template <class Entered, class Mark>
void slide(int cells, int behind, int ahead, Entered entered, Mark mark) {
  for (int window = 1 - ahead; window < cells + behind; ++window) {
    const int cell = window + ahead - 1;
    if (cell < cells) entered(cell);
    mark(window);
  }
}

/// Windows of `behind` + `ahead` cells on either axis, of which `behind` come before the cell that names
/// them.
Windows widened(const Windows& cells, int behind, int ahead) {
  constexpr int never = std::numeric_limits<int>::min() / 2;
  const int columns = static_cast<int>(cells.width);
  const int rows = static_cast<int>(cells.height);
  const int before = ahead - 1;
  Windows lines{.columns_before = before,
                .width = static_cast<std::size_t>(columns + behind + before),
                .height = cells.height};
  for (int row = 0; row < rows; ++row) {
    int last = never;
    slide(
        columns, behind, ahead,
        [&](int column) {
          if (cells.at(column, row, 0) != 0) last = column;
        },
        [&](int column) { lines.at(column, row, 0) = last >= column - behind ? 1 : 0; });
  }
  Windows windows{.columns_before = before,
                  .rows_before = before,
                  .width = lines.width,
                  .height = static_cast<std::size_t>(rows + behind + before)};
  std::vector<int> last(lines.width, never);
  slide(
      rows, behind, ahead,
      [&](int row) {
        const std::uint8_t* line = &lines.at(-before, row, 0);
        for (std::size_t i = 0; i < last.size(); ++i) last[i] = line[i] != 0 ? row : last[i];
      },
      [&](int row) {
        std::uint8_t* line = &windows.at(-before, row, 0);
        for (std::size_t i = 0; i < last.size(); ++i) line[i] = last[i] >= row - behind ? 1 : 0;
      });
  return windows;
}

}  // namespace

PoseBoxes::PoseBoxes(const Points& points, const CellFrame& frame, int top_level)
    : frame_(frame), top_level_(top_level), middle_x_(middle_of(points.x)), middle_y_(middle_of(points.y)) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i] - middle_x_;
    const double y = points.y[i] - middle_y_;
    points_.push_back({x, y, std::hypot(x, y)});
  }
  std::stable_sort(points_.begin(), points_.end(),
                   [](const Turning& a, const Turning& b) { return a.distance < b.distance; });
  constexpr double smallest_radius = 0.5;
  radius_ = std::max(points_.back().distance, smallest_radius);
  const double widest = std::ldexp(frame.cell / radius_, top_level);
  top_rotations_ = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / widest));
  find_clusters(std::ldexp(frame.cell, top_level) / 2.0);
}

/// Each point that is in none yet makes one with its nearest neighbours that are in none either, if they lie
/// in a disc of the widest radius.
void PoseBoxes::find_clusters(double widest) {
  std::vector<float> xs, ys;
  for (const Turning& point : points_) {
    xs.push_back(static_cast<float>(point.x));
    ys.push_back(static_cast<float>(point.y));
  }
  const Squares squares(xs, ys, 2.0 * widest);
  std::vector<bool> is_taken(points_.size(), false);
  std::vector<std::pair<double, std::uint32_t>> near;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (is_taken[i]) continue;
    near.clear();
    squares.near(xs[i], ys[i], [&](std::uint32_t k) {
      const double distance = std::hypot(points_[k].x - points_[i].x, points_[k].y - points_[i].y);
      if (!is_taken[k] && distance <= 2.0 * widest) near.emplace_back(distance, k);
    });
    if (near.size() < cluster_size) continue;
    const auto end = near.begin() + cluster_size;
    std::partial_sort(near.begin(), end, near.end());
    const auto middle_of_members = [&](auto coordinate) {
      double low = coordinate(points_[i]), high = low;
      for (auto member = near.begin(); member != end; ++member) {
        low = std::min(low, coordinate(points_[member->second]));
        high = std::max(high, coordinate(points_[member->second]));
      }
      return (low + high) / 2.0;
    };
    const double x = middle_of_members([](const Turning& point) { return point.x; });
    const double y = middle_of_members([](const Turning& point) { return point.y; });
    double radius = 0.0;
    for (auto member = near.begin(); member != end; ++member) {
      const Turning& point = points_[member->second];
      radius = std::max(radius, std::hypot(point.x - x, point.y - y));
    }
    if (radius > widest) continue;
    for (auto member = near.begin(); member != end; ++member) is_taken[member->second] = true;
    clusters_.push_back({x, y, std::hypot(x, y), radius});
  }
}

double PoseBoxes::angle(int level, std::size_t rotation) const {
  return 2.0 * half_width(level) * (static_cast<double>(rotation) + 0.5);
}

double PoseBoxes::half_width(int level) const {
  return std::numbers::pi / static_cast<double>(rotations(level));
}

double PoseBoxes::sway(int level, double local_x, double local_y) const {
  return std::hypot(local_x - middle_x_, local_y - middle_y_) * half_width(level);
}

Pose2 PoseBoxes::pose(int level, std::size_t rotation, double column, double row) const {
  const Pose2 moved{frame_.min_x + frame_.cell * column, frame_.min_y + frame_.cell * row,
                    angle(level, rotation)};
  return moved * Pose2{-middle_x_, -middle_y_, 0.0};
}

std::vector<CellPoints> PoseBoxes::cells(int level, std::size_t rotation) const {
  return cells_of(points_, groups(level), level, rotation);
}

std::vector<CellPoints> PoseBoxes::cluster_cells(std::size_t rotation) const {
  return cells_of(clusters_, cluster_groups(top_level_), top_level_, rotation);
}

std::vector<CellPoints> PoseBoxes::cells_of(const std::vector<Turning>& all, int groups, int level,
                                            std::size_t rotation) const {
  const double c = std::cos(angle(level, rotation));
  const double s = std::sin(angle(level, rotation));
  // Rounding must not leave a point a hair beside its window.
  constexpr double hair = 1e-6;
  std::vector<CellPoints> cells(static_cast<std::size_t>(groups));
  const double parts = PoseBoxes::groups(level);
  const double box = std::ldexp(frame_.cell, level);
  for (const Turning& one : all) {
    const double share = one.distance / radius_ + 2.0 * one.radius / box;
    const int group = std::clamp(static_cast<int>(std::ceil(parts * share - hair)), 1, groups);
    const double moved = (one.distance * half_width(level) + one.radius) / frame_.cell + hair;
    const int wider = PoseBoxes::wider(level, group);
    const auto cell_of = [&](double coordinate) {
      return static_cast<std::int32_t>(std::floor(coordinate / frame_.cell - moved)) + wider;
    };
    cells[static_cast<std::size_t>(group - 1)].push_back(cell_of(c * one.x - s * one.y),
                                                         cell_of(s * one.x + c * one.y));
  }
  return cells;
}

CellPoints PoseBoxes::middle_cells(std::size_t rotation) const {
  const double c = std::cos(angle(0, rotation));
  const double s = std::sin(angle(0, rotation));
  const auto cell_of = [&](double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate / frame_.cell + 0.5));
  };
  CellPoints cells;
  for (const Turning& point : points_)
    cells.push_back(cell_of(c * point.x - s * point.y), cell_of(s * point.x + c * point.y));
  return cells;
}

BoxPyramid::BoxPyramid(const Points& map_points, double cell, double epsilon, int top_level, int threads)
    : frame_(cell_frame(map_points, cell, epsilon + cell)),
      middles_(0, cells_near(map_points, frame_, epsilon, false, 0, Motion::planar)) {
  const Windows cells = cells_near(map_points, frame_, epsilon, true, 0, Motion::planar);
  std::vector<std::pair<int, int>> levels_and_groups;
  for (int level = 0; level <= top_level; ++level) {
    const int groups = level == top_level ? PoseBoxes::cluster_groups(level) : PoseBoxes::groups(level);
    for (int group = 1; group <= groups; ++group) levels_and_groups.emplace_back(level, group);
  }
  std::vector<std::optional<WindowBits>> bits(levels_and_groups.size());
  parallel_for(threads, bits.size(), [&](std::size_t i) {
    const auto [level, group] = levels_and_groups[i];
    bits[i].emplace(level, widened(cells, PoseBoxes::wider(level, group), 1 << level));
  });
  levels_.resize(static_cast<std::size_t>(top_level) + 1);
  for (std::size_t i = 0; i < bits.size(); ++i)
    levels_[static_cast<std::size_t>(levels_and_groups[i].first)].push_back(std::move(*bits[i]));
}

/// At the middle of a box a point lies in the middle one of three cells along either axis, or half a cell
/// beside it.
double BoxPyramid::delta() const {
  return 2.0 * std::numbers::sqrt2 * frame_.cell;
}

std::size_t BoxPyramid::memory_bytes() const {
  std::size_t bytes = middles_.memory_bytes();
  for (const std::vector<WindowBits>& groups : levels_) {
    for (const WindowBits& bits : groups) bytes += bits.memory_bytes();
  }
  return bytes;
}

std::size_t BoxPyramid::count(int level, const std::vector<CellPoints>& points, int column, int row,
                              std::size_t least, TileCounts& counts) const {
  std::size_t behind = 0;
  for (const CellPoints& group : points) behind += group.size();
  std::size_t looked_at = 0;
  counts.clear();
  for (std::size_t group = 0; group < points.size() && counts.largest() + behind >= least; ++group) {
    behind -= points[group].size();
    looked_at += levels_[static_cast<std::size_t>(level)][group].add(points[group], column, row, 0, least,
                                                                     behind, counts);
  }
  return looked_at;
}

void BoxPyramid::count_middles(const CellPoints& points, int column, int row, TileCounts& counts) const {
  counts.clear();
  middles_.add(points, column, row, 0, 0, 0, counts);
}

std::shared_ptr<const BoxPyramid> box_pyramid(const GlobalMap& map, double cell, double epsilon,
                                              int threads) {
  check_cell(cell, epsilon);
  constexpr double top_box = 0.4;  // m; larger ones bound nothing indoors
  const int top_level = std::max(0, static_cast<int>(std::lround(std::log2(top_box / cell))));
  return map.index<BoxPyramid>(fmt::format("{} {}", cell, epsilon),
                               [&] { return BoxPyramid(map.points(), cell, epsilon, top_level, threads); });
}

}  // namespace glocal
