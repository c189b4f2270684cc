#include "matchers/grid_search/box_pyramid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "matchers/common/squares.hpp"
#include "matchers/grid_search/pose_grid.hpp"
#include "matchers/grid_search/windows_of_map.hpp"

namespace glocal {

PoseBoxes::PoseBoxes(const Points& points, const CellFrame& frame, int top_level)
    : frame_(frame), top_level_(top_level), middle_x_(middle_of(points.x)), middle_y_(middle_of(points.y)) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i] - middle_x_;
    const double y = points.y[i] - middle_y_;
    const double layer = frame.in_space ? points.z[i] / frame.cell : 0.0;
    points_.push_back({.x = x, .y = y, .distance = std::hypot(x, y), .layer = layer});
  }
  std::stable_sort(points_.begin(), points_.end(),
                   [](const Turning& a, const Turning& b) { return a.distance < b.distance; });
  constexpr double smallest_radius = 0.5;
  radius_ = std::max(points_.back().distance, smallest_radius);
  const double widest = std::ldexp(frame.cell / radius_, top_level);
  top_rotations_ = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / widest));
  find_clusters(std::ldexp(frame.cell, top_level) / 2.0);
  put_rare_first(points_);
  put_rare_first(clusters_);
}

std::int32_t PoseBoxes::box_of_layers(int level, const Turning& one) const {
  return static_cast<std::int32_t>(std::floor(one.layer / layers_of_box(level, frame_)));
}

/// Those in boxes of layers with few of them before the others: a floor is in contact nearly everywhere, so
/// what tells places apart is to be looked at first.
void PoseBoxes::put_rare_first(std::vector<Turning>& all) const {
  std::map<std::int32_t, std::size_t> in_box;
  for (const Turning& one : all) ++in_box[box_of_layers(top_level_, one)];
  const auto neighbours = [&](const Turning& one) { return in_box[box_of_layers(top_level_, one)]; };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Turning& a, const Turning& b) { return neighbours(a) < neighbours(b); });
}

/// Each point that is in none yet makes one with its nearest neighbours that are in none either, if they lie
/// in a disc of the widest radius and in one box of layers.
void PoseBoxes::find_clusters(double widest) {
  std::vector<float> xs, ys;
  for (const Turning& point : points_) {
    xs.push_back(static_cast<float>(point.x));
    ys.push_back(static_cast<float>(point.y));
  }
  const Squares squares(xs, ys, 2.0 * widest);
  const auto box_of = [&](const Turning& point) { return box_of_layers(top_level_, point); };
  std::vector<bool> is_taken(points_.size(), false);
  std::vector<std::pair<double, std::uint32_t>> near;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (is_taken[i]) continue;
    near.clear();
    squares.near(xs[i], ys[i], [&](std::uint32_t k) {
      const double distance = std::hypot(points_[k].x - points_[i].x, points_[k].y - points_[i].y);
      if (!is_taken[k] && distance <= 2.0 * widest && box_of(points_[k]) == box_of(points_[i]))
        near.emplace_back(distance, k);
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
    clusters_.push_back(
        {.x = x, .y = y, .distance = std::hypot(x, y), .radius = radius, .layer = points_[i].layer});
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
    cells[static_cast<std::size_t>(group - 1)].push_back(
        cell_of(c * one.x - s * one.y), cell_of(s * one.x + c * one.y), box_of_layers(level, one));
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
    cells.push_back(cell_of(c * point.x - s * point.y), cell_of(s * point.x + c * point.y),
                    static_cast<std::int32_t>(std::floor(point.layer + 0.5)));
  return cells;
}

BoxPyramid::BoxPyramid(const Points& map_points, double cell, double epsilon, int top_level, int threads,
                       Motion motion)
    : frame_(cell_frame(map_points, cell, epsilon + cell, motion)),
      middles_(windows_of_map(map_points, frame_, epsilon, false, {WindowKind{}}, threads).front()) {
  std::vector<WindowKind> kinds;
  for (int level = 0; level <= top_level; ++level) {
    const int groups = level == top_level ? PoseBoxes::cluster_groups(level) : PoseBoxes::groups(level);
    const int step = PoseBoxes::layers_of_box(level, frame_);
    for (int group = 1; group <= groups; ++group) {
      kinds.push_back({.level = level,
                       .wider = PoseBoxes::wider(level, group),
                       .height = frame_.in_space ? 2 * step : 1,
                       .step = step});
    }
  }
  std::vector<WindowBits> bits = windows_of_map(map_points, frame_, epsilon, true, kinds, threads);
  levels_.resize(static_cast<std::size_t>(top_level) + 1);
  for (std::size_t k = 0; k < kinds.size(); ++k)
    levels_[static_cast<std::size_t>(kinds[k].level)].push_back(std::move(bits[k]));
}

/// At the middle of a box a point lies in the middle one of three cells along either axis, or half a cell
/// beside it; in space it lies in two layers, half a cell from their middle at most.
double BoxPyramid::delta() const {
  constexpr double aside = 2.0;
  constexpr double above = 1.5;
  return frame_.cell * std::hypot(aside, aside, frame_.in_space ? above : 0.0);
}

BoxPyramid::BoxesOfLayers BoxPyramid::boxes_of_layers(int level) const {
  const WindowBits& bits = levels_[static_cast<std::size_t>(level)].front();
  return {-bits.layers_before(), bits.layers() - bits.layers_before() - 1};
}

std::size_t BoxPyramid::memory_bytes() const {
  std::size_t bytes = middles_.memory_bytes();
  for (const std::vector<WindowBits>& groups : levels_) {
    for (const WindowBits& bits : groups) bytes += bits.memory_bytes();
  }
  return bytes;
}

std::size_t BoxPyramid::count(int level, const std::vector<CellPoints>& points, int column, int row,
                              int layer, std::size_t least, TileCounts& counts) const {
  std::size_t behind = 0;
  for (const CellPoints& group : points) behind += group.size();
  std::size_t looked_at = 0;
  counts.clear();
  for (std::size_t group = points.size(); group-- > 0 && counts.largest() + behind >= least;) {
    behind -= points[group].size();
    looked_at += levels_[static_cast<std::size_t>(level)][group].add(points[group], column, row, layer, least,
                                                                     behind, counts);
  }
  return looked_at;
}

void BoxPyramid::count_middles(const CellPoints& points, int column, int row, int layer,
                               TileCounts& counts) const {
  counts.clear();
  middles_.add(points, column, row, layer, 0, 0, counts);
}

std::shared_ptr<const BoxPyramid> box_pyramid(const GlobalMap& map, double cell, double epsilon,
                                              Motion motion, int threads) {
  check_cell(cell, epsilon);
  const bool in_space = motion != Motion::planar;
  constexpr double top_box = 0.4;  // m; larger ones bound nothing indoors
  const int top_level = in_space ? BoxPyramid::default_top_level
                                 : std::max(0, static_cast<int>(std::lround(std::log2(top_box / cell))));
  return map.index<BoxPyramid>(fmt::format("{} {}{}", cell, epsilon, in_space ? " in space" : ""), [&] {
    return BoxPyramid(map.points(), cell, epsilon, top_level, threads, motion);
  });
}

}  // namespace glocal
