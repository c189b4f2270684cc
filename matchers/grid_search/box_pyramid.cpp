#include "matchers/grid_search/box_pyramid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "glocal/parallel.hpp"
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
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); ++i)
    distances.push_back(std::hypot(points.x[i] - middle_x_, points.y[i] - middle_y_));
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distances[a] < distances[b]; });
  points_.reserve(points.size());
  for (const std::size_t i : order) {
    points_.push_back(points[i]);
    distances_.push_back(distances[i]);
  }
  constexpr double smallest_radius = 0.5;
  radius_ = std::max(distances_.back(), smallest_radius);
  const double widest = std::ldexp(frame.cell / radius_, top_level);
  top_rotations_ = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / widest));
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
  const double c = std::cos(angle(level, rotation));
  const double s = std::sin(angle(level, rotation));
  // Rounding must not leave a point a hair beside its window.
  constexpr double hair = 1e-6;
  std::vector<CellPoints> groups(static_cast<std::size_t>(PoseBoxes::groups(level)));
  const auto parts = static_cast<double>(groups.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double x = points_.x[i] - middle_x_;
    const double y = points_.y[i] - middle_y_;
    const int group = std::max(1, static_cast<int>(std::ceil(parts * distances_[i] / radius_ - hair)));
    const double moved = distances_[i] * half_width(level) / frame_.cell + hair;
    const int wider = PoseBoxes::wider(level, group);
    const auto cell_of = [&](double coordinate) {
      return static_cast<std::int32_t>(std::floor(coordinate / frame_.cell - moved)) + wider;
    };
    groups[static_cast<std::size_t>(group - 1)].push_back(cell_of(c * x - s * y), cell_of(s * x + c * y));
  }
  return groups;
}

CellPoints PoseBoxes::middle_cells(std::size_t rotation) const {
  const double c = std::cos(angle(0, rotation));
  const double s = std::sin(angle(0, rotation));
  const auto cell_of = [&](double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate / frame_.cell + 0.5));
  };
  CellPoints cells;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double x = points_.x[i] - middle_x_;
    const double y = points_.y[i] - middle_y_;
    cells.push_back(cell_of(c * x - s * y), cell_of(s * x + c * y));
  }
  return cells;
}

BoxPyramid::BoxPyramid(const Points& map_points, double cell, double epsilon, int top_level, int threads)
    : frame_(cell_frame(map_points, cell, epsilon + cell)),
      middles_(0, cells_near(map_points, frame_, epsilon, false, 0, Motion::planar)) {
  const Windows cells = cells_near(map_points, frame_, epsilon, true, 0, Motion::planar);
  std::vector<std::pair<int, int>> levels_and_groups;
  for (int level = 0; level <= top_level; ++level) {
    for (int group = 1; group <= PoseBoxes::groups(level); ++group)
      levels_and_groups.emplace_back(level, group);
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
