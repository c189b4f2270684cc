#include "sources/simulation/near_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glocal::simulation {
namespace {

constexpr double least_side = 10.0;  // m
constexpr double most_cells_a_side = 256.0;
constexpr std::size_t most_cells_a_shape = 64;

struct Bounds {
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  Position low{infinite, infinite};
  Position high{-infinite, -infinite};

  void add(const Position& place) {
    for (std::size_t axis = 0; axis < place.size(); ++axis) {
      low[axis] = std::min(low[axis], place[axis]);
      high[axis] = std::max(high[axis], place[axis]);
    }
  }
};

Bounds bounds_of(const Segment& segment) {
  Bounds bounds;
  bounds.add(segment.from);
  bounds.add(segment.to);
  return bounds;
}

Bounds bounds_of(const Circle& circle) {
  const auto& [x, y] = circle.centre;
  return {{x - circle.radius, y - circle.radius}, {x + circle.radius, y + circle.radius}};
}

}  // namespace

NearShapes::NearShapes(const Shapes& shapes) : shapes_{shapes.segments, shapes.circles, {}} {
  Bounds all;
  const auto add = [&](const Bounds& bounds) {
    all.add(bounds.low);
    all.add(bounds.high);
  };
  for (const Segment& segment : shapes_.segments) add(bounds_of(segment));
  for (const Circle& circle : shapes_.circles) add(bounds_of(circle));
  if (shapes_.segments.empty() && shapes_.circles.empty()) all.low = all.high = {};
  low_ = all.low;
  const Position extent{all.high[0] - all.low[0], all.high[1] - all.low[1]};
  side_ = std::max(least_side, std::max(extent[0], extent[1]) / most_cells_a_side);
  columns_ = static_cast<std::size_t>(extent[0] / side_) + 1;
  cells_.resize(columns_ * (static_cast<std::size_t>(extent[1] / side_) + 1));
  std::uint32_t index = 0;
  const auto sort = [&](const Bounds& bounds) { sort_in(index++, bounds.low, bounds.high); };
  for (const Segment& segment : shapes_.segments) sort(bounds_of(segment));
  for (const Circle& circle : shapes_.circles) sort(bounds_of(circle));
}

Shapes NearShapes::around(const Position& place, double reach) const {
  const CellRange columns = cells_from(0, place[0] - reach, place[0] + reach);
  const CellRange rows = cells_from(1, place[1] - reach, place[1] + reach);
  std::vector<std::uint32_t> found = wide_;
  for (std::size_t row = rows.first; row <= rows.last; ++row) {
    for (std::size_t column = columns.first; column <= columns.last; ++column) {
      const std::vector<std::uint32_t>& cell = cells_[row * columns_ + column];
      found.insert(found.end(), cell.begin(), cell.end());
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  Shapes near;
  for (const std::uint32_t i : found) {
    if (i < shapes_.segments.size()) {
      near.segments.push_back(shapes_.segments[i]);
    } else {
      near.circles.push_back(shapes_.circles[i - shapes_.segments.size()]);
    }
  }
  return near;
}

NearShapes::CellRange NearShapes::cells_from(std::size_t axis, double from, double to) const {
  const std::size_t count = axis == 0 ? columns_ : cells_.size() / columns_;
  const auto cell_at = [&](double x) {
    return static_cast<std::size_t>(
        std::clamp(std::floor((x - low_[axis]) / side_), 0.0, static_cast<double>(count - 1)));
  };
  return {cell_at(from), cell_at(to)};
}

void NearShapes::sort_in(std::uint32_t shape, const Position& low, const Position& high) {
  const CellRange columns = cells_from(0, low[0], high[0]);
  const CellRange rows = cells_from(1, low[1], high[1]);
  const std::size_t n = (columns.last - columns.first + 1) * (rows.last - rows.first + 1);
  if (n > most_cells_a_shape) {
    wide_.push_back(shape);
    return;
  }
  for (std::size_t row = rows.first; row <= rows.last; ++row) {
    for (std::size_t column = columns.first; column <= columns.last; ++column)
      cells_[row * columns_ + column].push_back(shape);
  }
}

}  // namespace glocal::simulation
