#include "matchers/box_search/box_pyramid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "matchers/box_search/pose_boxes.hpp"
#include "matchers/box_search/windows_of_map.hpp"

namespace glocal {
namespace {

/// Of a grid's boxes: as large as they are, and beginning anywhere.
std::vector<WindowKind> kinds_of_grid(int top_level, const CellFrame& frame) {
  std::vector<WindowKind> kinds;
  for (int level = 0; level <= top_level; ++level)
    kinds.push_back({.level = level, .height = frame.in_space ? 1 << level : 1});
  return kinds;
}

/// Of boxes of all poses: wider by what the rotations of a box move a point. In space they are twice as high
/// as a box, so that a point meets one of them wherever it lies in its own, and higher by what tilts move it.
std::vector<WindowKind> kinds_of_all_poses(int top_level, const CellFrame& frame, Motion motion) {
  std::vector<WindowKind> kinds;
  for (int level = 0; level <= top_level; ++level) {
    const int groups =
        level == top_level ? AllPoses::wide_groups(level) : AllPoses::groups_of_points(level, motion);
    for (int group = 1; group <= groups; ++group) {
      kinds.push_back({.level = level,
                       .wider = AllPoses::wider(level, group),
                       .height = AllPoses::layers_of_window(level, frame, motion),
                       .step = AllPoses::layers_of_box(level, frame)});
    }
  }
  return kinds;
}

}  // namespace

BoxPyramid::BoxPyramid(Of of, const Points& map_points, double cell, double epsilon, int top_level,
                       int threads, Motion motion)
    : of_(of),
      motion_(motion),
      // At the nearest of their places, cells a little farther away are in contact, too.
      frame_(cell_frame(map_points, cell, of == Of::pose_grid ? epsilon : epsilon + cell, motion)) {
  const bool is_grid = of == Of::pose_grid;
  if (!is_grid) middles_ = windows_of_map(map_points, frame_, epsilon, false, {WindowKind{}}, threads);
  const std::vector<WindowKind> kinds =
      is_grid ? kinds_of_grid(top_level, frame_) : kinds_of_all_poses(top_level, frame_, motion);
  std::vector<WindowBits> bits = windows_of_map(map_points, frame_, epsilon, !is_grid, kinds, threads);
  levels_.resize(static_cast<std::size_t>(top_level) + 1);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    Level& level = levels_[static_cast<std::size_t>(kinds[k].level)];
    level.step = kinds[k].step;
    level.bits.push_back(std::move(bits[k]));
  }
}

/// At the middle of a box a point lies in the middle of its window, or half a cell or a layer beside it.
double BoxPyramid::delta() const {
  const int columns = 1 + AllPoses::wider(0, AllPoses::groups_of_points(0, motion_));
  const double aside = (columns + 1) / 2.0;
  const double above = (AllPoses::layers_of_window(0, frame_, motion_) + 1) / 2.0;
  return frame_.cell * std::hypot(aside, aside, frame_.in_space ? above : 0.0);
}

std::size_t BoxPyramid::memory_bytes() const {
  std::size_t bytes = 0;
  for (const WindowBits& bits : middles_) bytes += bits.memory_bytes();
  for (const Level& level : levels_) {
    for (const WindowBits& bits : level.bits) bytes += bits.memory_bytes();
  }
  return bytes;
}

std::size_t BoxPyramid::count(int level, const std::vector<CellPoints>& points, int column, int row,
                              int layer, std::size_t least, TileCounts& counts) const {
  const auto& [step, bits] = levels_[static_cast<std::size_t>(level)];
  std::size_t behind = 0;
  for (const CellPoints& group : points) behind += group.size();
  std::size_t looked_at = 0;
  counts.clear();
  // Near points first: their windows are small, and fewer of them are in contact by chance.
  for (std::size_t group = 0; group < points.size() && counts.largest() + behind >= least; ++group) {
    behind -= points[group].size();
    looked_at += bits[group].add(points[group], column, row, layer / step, least, behind, counts);
  }
  return looked_at;
}

void BoxPyramid::count_middles(const CellPoints& points, int column, int row, int layer,
                               TileCounts& counts) const {
  counts.clear();
  middles_.front().add(points, column, row, layer, 0, 0, counts);
}

std::shared_ptr<const BoxPyramid> box_pyramid(BoxPyramid::Of of, const GlobalMap& map, double cell,
                                              double epsilon, Motion motion, int threads) {
  check_cell(cell, epsilon);
  const bool in_space = motion != Motion::planar;
  const bool is_grid = of == BoxPyramid::Of::pose_grid;
  constexpr double top_box = 0.4;  // m
  const int top_level = is_grid || in_space
                            ? BoxPyramid::default_top_level(of, motion)
                            : std::max(0, static_cast<int>(std::lround(std::log2(top_box / cell))));
  const std::string key =
      fmt::format("{} {} {}{}", cell, epsilon, to_string(motion), is_grid ? " of a grid" : "");
  return map.index<BoxPyramid>(
      key, [&] { return BoxPyramid(of, map.points(), cell, epsilon, top_level, threads, motion); });
}

}  // namespace glocal
