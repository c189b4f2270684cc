#include "matchers/box_search/pose_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "glocal/extent.hpp"
#include "glocal/rounded_down.hpp"
#include "matchers/common/squares.hpp"

namespace glocal {

PoseBoxes::PoseBoxes(const Points& points, const CellFrame& frame, Motion motion)
    : frame_(frame), middle_x_(extent_of(points.x).middle()), middle_y_(extent_of(points.y).middle()) {
  if (motion == Motion::free) tilt_height_ = extent_of(points.z).middle();
}

double PoseBoxes::sway(int level, const Vector3& local) const {
  const Vector3 from_middle = local - middle();
  const double aside = std::hypot(from_middle.x(), from_middle.y());
  return (tilt() ? std::hypot(aside, from_middle.z()) : aside) * half_width(level);
}

Pose2 PoseBoxes::pose(int level, std::size_t rotation, double column, double row) const {
  const Pose2 moved{frame_.min_x + frame_.cell * column, frame_.min_y + frame_.cell * row,
                    angle(level, rotation)};
  return moved * Pose2{-middle_x_, -middle_y_, 0.0};
}

PoseGrid::PoseGrid(const Points& points, const CellFrame& frame, double min_rotation_step,
                   double robot_height)
    : PoseBoxes(points, frame, Motion::upright), points_(points), robot_height_(robot_height) {
  constexpr double max_rotation_step = 0.1;
  double radius = 0.0;
  layers_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    radius = std::max(radius, std::hypot(points.x[i] - middle_x(), points.y[i] - middle_y()));
    layers_.push_back(rounded_down<std::int32_t>(points.z[i] / frame.cell));
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
    return rounded_down<std::int32_t>(coordinate / frame().cell);
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
  const auto [left, right] = std::ranges::minmax(columns);
  const auto [low, high] = std::ranges::minmax(rows);
  Translations all{-right, frame().columns - 1 - left, -high, frame().rows - 1 - low};
  if (frame().in_space) {
    const double height = robot_height_ / frame().cell;
    all.first_layer = static_cast<int>(std::ceil(-height));
    all.last_layer = static_cast<int>(std::ceil(frame().layers - height)) - 1;
  }
  return all;
}

AllPoses::AllPoses(const Points& points, const CellFrame& frame, int top_level, Motion motion)
    : PoseBoxes(points, frame, motion), top_level_(top_level) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i] - middle_x();
    const double y = points.y[i] - middle_y();
    const double z = points.z[i] - middle().z();
    points_.push_back({.x = x,
                       .y = y,
                       .distance = tilt() ? std::hypot(x, y, z) : std::hypot(x, y),
                       .layer = frame.in_space ? z / frame.cell : 0.0});
  }
  std::ranges::stable_sort(points_, {}, &Turning::distance);
  constexpr double smallest_radius = 0.5;
  radius_ = std::max(points_.back().distance, smallest_radius);
  const double widest = std::ldexp(frame.cell / radius_, top_level);
  top_turns_ = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / widest));
  if (tilt()) {
    tilts_ = largest_tilts();
  } else {
    find_clusters(std::ldexp(frame.cell, top_level) / 2.0);
  }
  put_rare_first(points_);
  put_rare_first(clusters_);
}

/// That move points by no more than their windows are wider and higher, which are halved as tilts are.
TiltSquares AllPoses::largest_tilts() const {
  const double box = std::ldexp(frame().cell, top_level_);
  const double rise = frame().cell * AllPoses::rise(top_level_, Motion::free);
  return TiltSquares([&](double reach) {
    return std::ranges::all_of(points_, [&](const Turning& point) {
      const double height =
          std::abs(point.layer) * frame().cell + TiltSquares::largest(reach) * point.distance;
      return 2.0 * TiltSquares::aside(reach, height, point.distance) < box && reach * point.distance < rise;
    });
  });
}

std::size_t AllPoses::rotations(int level) const {
  const int halvings = top_level_ - level;
  return tilts_ ? (top_turns_ * tilts_->size()) << (3 * halvings) : top_turns_ << halvings;
}

std::vector<std::size_t> AllPoses::parts(int level, std::size_t rotation) const {
  if (!tilts_) return {2 * rotation, 2 * rotation + 1};
  std::vector<std::size_t> parts;
  for (std::size_t part = 8 * rotation; part < 8 * (rotation + 1); ++part) {
    if (tilts_->is_of_interest(rotations_of(level - 1, part).tilt, top_level_ - level + 1))
      parts.push_back(part);
  }
  return parts;
}

/// Where poses tilt, the last bit of a part's number says which half of the turns it has, and the two before
/// which quarter of the tilts.
AllPoses::Rotations AllPoses::rotations_of(int level, std::size_t rotation) const {
  if (!tilts_) return {rotation};
  const int halvings = top_level_ - level;
  const std::size_t first = rotation >> (3 * halvings);
  std::size_t turn = first % top_turns_;
  std::size_t quarters = 0;
  for (int bit = 3 * (halvings - 1); bit >= 0; bit -= 3) {
    turn = 2 * turn + (rotation >> bit & 1);
    quarters = 4 * quarters + (rotation >> (bit + 1) & 3);
  }
  return {turn, tilts_->middle(first / top_turns_, quarters, halvings)};
}

Pose3 AllPoses::tilted_from_local(int level, std::size_t rotation) const {
  if (!tilts_) return {};
  const Quaternion tilt = exponential(rotations_of(level, rotation).tilt);
  return Pose3(middle()) * Pose3(tilt) * Pose3(Vector3(-middle()));
}

std::int32_t AllPoses::box_of_layers(int level, const Turning& one) const {
  const int rise = AllPoses::rise(level, motion());
  return rounded_down<std::int32_t>((one.layer - rise) / layers_of_box(level));
}

/// Those in boxes of layers with few of them before the others: a floor is in contact nearly everywhere, so
/// what tells places apart is to be looked at first.
void AllPoses::put_rare_first(std::vector<Turning>& all) const {
  std::map<std::int32_t, std::size_t> in_box;
  for (const Turning& one : all) ++in_box[box_of_layers(top_level_, one)];
  const auto neighbours = [&](const Turning& one) { return in_box[box_of_layers(top_level_, one)]; };
  std::ranges::stable_sort(all, {}, neighbours);
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
  return 2.0 * half_turn(level) * (static_cast<double>(rotations_of(level, rotation).turn) + 0.5);
}

double AllPoses::half_width(int level) const {
  return half_turn(level) + (tilts_ ? tilts_->reach(top_level_ - level) : 0.0);
}

double AllPoses::half_turn(int level) const {
  return std::numbers::pi / static_cast<double>(top_turns_ << (top_level_ - level));
}

std::vector<CellPoints> AllPoses::cells(int level, std::size_t rotation) const {
  return cells_of(points_, groups_of_points(level, motion()), level, rotation);
}

std::vector<CellPoints> AllPoses::cluster_cells(std::size_t rotation) const {
  return cells_of(clusters_, wide_groups(top_level_), top_level_, rotation);
}

AllPoses::Turning AllPoses::tilted(const Turning& one, const Quaternion& tilt) const {
  const Vector3 place = tilt * Vector3{one.x, one.y, one.layer * frame().cell};
  Turning tilted = one;
  tilted.x = place.x();
  tilted.y = place.y();
  tilted.layer = place.z() / frame().cell;
  return tilted;
}

std::vector<CellPoints> AllPoses::cells_of(const std::vector<Turning>& all, int groups, int level,
                                           std::size_t rotation) const {
  const double c = std::cos(angle(level, rotation));
  const double s = std::sin(angle(level, rotation));
  const Quaternion tilt_of_middle = tilted_from_local(level, rotation).rotation;
  // Rounding must not leave a point a hair beside its window.
  constexpr double hair = 1e-6;
  std::vector<CellPoints> cells(static_cast<std::size_t>(groups));
  const double parts = AllPoses::groups(level);
  const double box = std::ldexp(frame().cell, level);
  for (const Turning& any : all) {
    const Turning one = tilt() ? tilted(any, tilt_of_middle) : any;
    double beside = one.radius;
    if (tilts_)
      beside += TiltSquares::aside(tilts_->reach(top_level_ - level), std::abs(one.layer) * frame().cell,
                                   one.distance);
    const double share = one.distance / radius_ + 2.0 * beside / box;
    const int group = std::clamp(-rounded_down<int>(hair - parts * share), 1, groups);
    const int wider = AllPoses::wider(level, group);
    // As much wider to either side, so that boxes are bounded alike however near the middle a point is.
    const double moved = (wider - 1) / 2.0 + hair;
    const auto cell_of = [&](double coordinate) {
      return rounded_down<std::int32_t>(coordinate / frame().cell - moved) + wider;
    };
    cells[static_cast<std::size_t>(group - 1)].push_back(
        cell_of(c * one.x - s * one.y), cell_of(s * one.x + c * one.y), box_of_layers(level, one));
  }
  return cells;
}

CellPoints AllPoses::middle_cells(std::size_t rotation) const {
  const double c = std::cos(angle(0, rotation));
  const double s = std::sin(angle(0, rotation));
  const Quaternion tilt_of_middle = tilted_from_local(0, rotation).rotation;
  const auto cell_of = [&](double coordinate) {
    return rounded_down<std::int32_t>(coordinate / frame().cell + 0.5);
  };
  CellPoints cells;
  for (const Turning& any : points_) {
    const Turning point = tilt() ? tilted(any, tilt_of_middle) : any;
    cells.push_back(cell_of(c * point.x - s * point.y), cell_of(s * point.x + c * point.y),
                    rounded_down<std::int32_t>(point.layer + 0.5));
  }
  return cells;
}

Translations AllPoses::translations(const std::vector<CellPoints>& cells, std::size_t least) const {
  // Those that leave `least` points among windows from the first one with a cell in contact to the last,
  // which is later by so many for points with wider ones.
  const auto range = [&](int first_window, int last_window, bool are_wider,
                         auto coordinates_of) -> std::pair<int, int> {
    std::vector<int> first, last;
    first.reserve(points_.size());
    last.reserve(points_.size());
    for (std::size_t g = 0; g < cells.size(); ++g) {
      const int more = are_wider ? wider(top_level_, static_cast<int>(g) + 1) : 0;
      for (const std::int32_t coordinate : coordinates_of(cells[g])) {
        first.push_back(first_window - coordinate);
        last.push_back(last_window + more - coordinate);
      }
    }
    const auto nth = static_cast<std::ptrdiff_t>(least - 1);
    std::ranges::nth_element(first, first.begin() + nth);
    std::ranges::nth_element(last, last.begin() + nth, std::greater<>());
    return {first[least - 1], last[least - 1]};
  };
  const int first_window = 1 - (1 << top_level_);
  const auto [left, right] =
      range(first_window, frame().columns - 1, true, [](const CellPoints& p) { return p.columns(); });
  const auto [low, high] =
      range(first_window, frame().rows - 1, true, [](const CellPoints& p) { return p.rows(); });
  if (!frame().in_space) return {left, right, low, high};
  const int step = layers_of_box(top_level_);
  const int window = layers_of_window(top_level_, frame(), motion());
  const auto [bottom, ceiling] = range(-(window - 1) / step, (frame().layers - 1) / step, false,
                                       [](const CellPoints& p) { return p.layers(); });
  return {left, right, low, high, step * bottom, step * (ceiling + 1) - 1};
}

}  // namespace glocal
