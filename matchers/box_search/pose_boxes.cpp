#include "matchers/box_search/pose_boxes.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "glocal/extent.hpp"
#include "matchers/common/squares.hpp"

namespace glocal {

PoseBoxes::PoseBoxes(const Points& points, const CellFrame& frame)
    : frame_(frame), middle_x_(extent_of(points.x).middle()), middle_y_(extent_of(points.y).middle()) {}

Pose2 PoseBoxes::pose(int level, std::size_t rotation, double column, double row) const {
  const Pose2 moved{frame_.min_x + frame_.cell * column, frame_.min_y + frame_.cell * row,
                    angle(level, rotation)};
  return moved * Pose2{-middle_x_, -middle_y_, 0.0};
}

PoseGrid::PoseGrid(const Points& points, const CellFrame& frame, double min_rotation_step,
                   double robot_height)
    : PoseBoxes(points, frame), points_(points), robot_height_(robot_height) {
  constexpr double max_rotation_step = 0.1;
  double radius = 0.0;
  layers_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    radius = std::max(radius, std::hypot(points.x[i] - middle_x(), points.y[i] - middle_y()));
    layers_.push_back(static_cast<std::int32_t>(std::floor(points.z[i] / frame.cell)));
  }
  const double step = std::min(max_rotation_step, std::max(min_rotation_step, frame.cell / radius));
  rotations_ = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / step));
}

double PoseGrid::angle(int /*level*/, std::size_t rotation) const {
  return 2.0 * std::numbers::pi * static_cast<double>(rotation) / static_cast<double>(rotations_);
}

std::vector<CellPoints> PoseGrid::cells(int level, std::size_t rotation) const {
  const double c = std::cos(angle(level, rotation));
  const double s = std::sin(angle(level, rotation));
  const auto cell_of = [&](double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate / frame().cell));
  };
  CellPoints cells;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double x = points_.x[i] - middle_x();
    const double y = points_.y[i] - middle_y();
    cells.push_back(cell_of(c * x - s * y), cell_of(s * x + c * y), layers_[i]);
  }
  return {std::move(cells)};
}

Translations PoseGrid::translations(const std::vector<CellPoints>& cells, std::size_t /*least*/) const {
  const auto columns = cells.front().columns();
  const auto rows = cells.front().rows();
  const auto [left, right] = std::minmax_element(columns.begin(), columns.end());
  const auto [low, high] = std::minmax_element(rows.begin(), rows.end());
  Translations all{-*right, frame().columns - 1 - *left, -*high, frame().rows - 1 - *low};
  if (frame().in_space) {
    const double height = robot_height_ / frame().cell;
    all.first_layer = static_cast<int>(std::ceil(-height));
    all.last_layer = static_cast<int>(std::ceil(frame().layers - height)) - 1;
  }
  return all;
}

AllPoses::AllPoses(const Points& points, const CellFrame& frame, int top_level)
    : PoseBoxes(points, frame), top_level_(top_level) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i] - middle_x();
    const double y = points.y[i] - middle_y();
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

std::int32_t AllPoses::box_of_layers(int level, const Turning& one) const {
  return static_cast<std::int32_t>(std::floor(one.layer / layers_of_box(level)));
}

/// Those in boxes of layers with few of them before the others: a floor is in contact nearly everywhere, so
/// what tells places apart is to be looked at first.
void AllPoses::put_rare_first(std::vector<Turning>& all) const {
  std::map<std::int32_t, std::size_t> in_box;
  for (const Turning& one : all) ++in_box[box_of_layers(top_level_, one)];
  const auto neighbours = [&](const Turning& one) { return in_box[box_of_layers(top_level_, one)]; };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Turning& a, const Turning& b) { return neighbours(a) < neighbours(b); });
}

/// Each point that is in none yet makes one with its nearest neighbours that are in none either, if they lie
/// in a disc of the widest radius and in one box of layers.
void AllPoses::find_clusters(double widest) {
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
    std::partial_sort(near.begin(), near.begin() + cluster_size, near.end());
    std::vector<std::uint32_t> members;
    for (std::size_t k = 0; k < cluster_size; ++k) members.push_back(near[k].second);
    const Turning disc = disc_about(members);
    if (disc.radius > widest) continue;
    for (const std::uint32_t member : members) is_taken[member] = true;
    clusters_.push_back(disc);
  }
}

AllPoses::Turning AllPoses::disc_about(const std::vector<std::uint32_t>& members) const {
  const auto middle = [&](double Turning::*coordinate) {
    double low = points_[members.front()].*coordinate, high = low;
    for (const std::uint32_t member : members) {
      low = std::min(low, points_[member].*coordinate);
      high = std::max(high, points_[member].*coordinate);
    }
    return (low + high) / 2.0;
  };
  Turning disc{.x = middle(&Turning::x), .y = middle(&Turning::y), .distance = 0.0};
  for (const std::uint32_t member : members)
    disc.radius = std::max(disc.radius, std::hypot(points_[member].x - disc.x, points_[member].y - disc.y));
  disc.distance = std::hypot(disc.x, disc.y);
  disc.layer = points_[members.front()].layer;
  return disc;
}

double AllPoses::angle(int level, std::size_t rotation) const {
  return 2.0 * half_width(level) * (static_cast<double>(rotation) + 0.5);
}

double AllPoses::half_width(int level) const {
  return std::numbers::pi / static_cast<double>(rotations(level));
}

std::vector<CellPoints> AllPoses::cells(int level, std::size_t rotation) const {
  return cells_of(points_, groups(level), level, rotation);
}

std::vector<CellPoints> AllPoses::cluster_cells(std::size_t rotation) const {
  return cells_of(clusters_, cluster_groups(top_level_), top_level_, rotation);
}

std::vector<CellPoints> AllPoses::cells_of(const std::vector<Turning>& all, int groups, int level,
                                           std::size_t rotation) const {
  const double c = std::cos(angle(level, rotation));
  const double s = std::sin(angle(level, rotation));
  // Rounding must not leave a point a hair beside its window.
  constexpr double hair = 1e-6;
  std::vector<CellPoints> cells(static_cast<std::size_t>(groups));
  const double parts = AllPoses::groups(level);
  const double box = std::ldexp(frame().cell, level);
  for (const Turning& one : all) {
    const double share = one.distance / radius_ + 2.0 * one.radius / box;
    const int group = std::clamp(static_cast<int>(std::ceil(parts * share - hair)), 1, groups);
    const double moved = (one.distance * half_width(level) + one.radius) / frame().cell + hair;
    const int wider = AllPoses::wider(level, group);
    const auto cell_of = [&](double coordinate) {
      return static_cast<std::int32_t>(std::floor(coordinate / frame().cell - moved)) + wider;
    };
    cells[static_cast<std::size_t>(group - 1)].push_back(
        cell_of(c * one.x - s * one.y), cell_of(s * one.x + c * one.y), box_of_layers(level, one));
  }
  return cells;
}

CellPoints AllPoses::middle_cells(std::size_t rotation) const {
  const double c = std::cos(angle(0, rotation));
  const double s = std::sin(angle(0, rotation));
  const auto cell_of = [&](double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate / frame().cell + 0.5));
  };
  CellPoints cells;
  for (const Turning& point : points_)
    cells.push_back(cell_of(c * point.x - s * point.y), cell_of(s * point.x + c * point.y),
                    static_cast<std::int32_t>(std::floor(point.layer + 0.5)));
  return cells;
}

Translations AllPoses::translations(const std::vector<CellPoints>& cells, std::size_t least) const {
  // Those that leave `least` points among windows from the first one with a cell in contact to the last,
  // which is later by so many for points with wider ones.
  const auto range = [&](int first_window, int last_window, bool are_wider,
                         auto coordinates_of) -> std::pair<int, int> {
    std::vector<int> first, last;
    for (std::size_t g = 0; g < cells.size(); ++g) {
      const int more = are_wider ? wider(top_level_, static_cast<int>(g) + 1) : 0;
      for (const std::int32_t coordinate : coordinates_of(cells[g])) {
        first.push_back(first_window - coordinate);
        last.push_back(last_window + more - coordinate);
      }
    }
    const auto nth = static_cast<std::ptrdiff_t>(least - 1);
    std::nth_element(first.begin(), first.begin() + nth, first.end());
    std::nth_element(last.begin(), last.begin() + nth, last.end(), std::greater<>());
    return {first[least - 1], last[least - 1]};
  };
  const int first_window = 1 - (1 << top_level_);
  const auto [left, right] =
      range(first_window, frame().columns - 1, true, [](const CellPoints& p) { return p.columns(); });
  const auto [low, high] =
      range(first_window, frame().rows - 1, true, [](const CellPoints& p) { return p.rows(); });
  const int step = layers_of_box(top_level_);
  const auto [bottom, ceiling] = range(frame().in_space ? -1 : 0, (frame().layers - 1) / step, false,
                                       [](const CellPoints& p) { return p.layers(); });
  return {left, right, low, high, step * bottom, step * (ceiling + 1) - 1};
}

}  // namespace glocal
