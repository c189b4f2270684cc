#include "glocal/clearance_grid.hpp"

#include <algorithm>
#include <cmath>

#include "maps/look_up.hpp"

namespace glocal {
namespace {

constexpr std::size_t padding = 3;

}  // namespace

ClearanceGrid::ClearanceGrid(const OccupancyGrid& grid)
    : grid_from_map_(inverse(grid.map_from_grid)),
      resolution_(static_cast<float>(grid.resolution)),
      width_(grid.width),
      height_(grid.height),
      clearance_(grid.cells.size() + padding) {
  constexpr int most = 255;
  const auto at = [&](int column, int row) -> int {
    const bool inside = column >= 0 && row >= 0 && column < width_ && row < height_;
    return inside ? clearance_[index(column, row)] : most;
  };
  const auto lower = [&](int column, int row, int neighbour) {
    std::uint8_t& cell = clearance_[index(column, row)];
    cell = static_cast<std::uint8_t>(std::min<int>(cell, std::min(neighbour + 1, most)));
  };
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    clearance_[i] = grid.cells[i] == Cell::occupied ? 0 : most;
  // Two passes over the neighbours already visited give the chessboard distance (Rosenfeld and Pfaltz 1966).
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      for (int d = -1; d <= 1; ++d) lower(column, row, at(column + d, row - 1));
      lower(column, row, at(column - 1, row));
    }
  }
  for (int row = height_ - 1; row >= 0; --row) {
    for (int column = width_ - 1; column >= 0; --column) {
      for (int d = -1; d <= 1; ++d) lower(column, row, at(column + d, row + 1));
      lower(column, row, at(column + 1, row));
    }
  }
}

std::optional<double> ClearanceGrid::first_occupied(const Point& from, const Point& to, double margin) const {
  const Point a = grid_from_map_(from);
  const Point b = grid_from_map_(to);
  const float dx = b.x - a.x;
  const float dy = b.y - a.y;
  const float length = std::sqrt(dx * dx + dy * dy);
  if (clearance_.size() == padding || !(length > 0.0F)) return std::nullopt;
  const float scale = 1.0F / resolution_;
  const float end = (length - static_cast<float>(margin)) * scale;
  const float columns = dx / length, rows = dy / length;
  bool was_inside = false;
  for (float t = 0.5F; t <= end;) {
    const float column = a.x * scale + t * columns;
    const float row = a.y * scale + t * rows;
    const bool inside = column >= 0.0F && row >= 0.0F && column < static_cast<float>(width_) &&
                        row < static_cast<float>(height_);
    // A ray that has left the grid does not come back.
    if (was_inside && !inside) return std::nullopt;
    was_inside = inside;
    const int clearance = inside ? clearance_[index(static_cast<int>(column), static_cast<int>(row))] : 1;
    if (clearance == 0) return t * resolution_;
    t += std::max(0.5F, static_cast<float>(clearance - 1));
  }
  return std::nullopt;
}

void ClearanceGrid::find_blocked(const Point& from, const Points& ends, const Transform& map_from_ends,
                                 double margin, std::vector<std::uint8_t>& blocked) const {
  blocked.assign(ends.size(), 0);
  if (clearance_.size() == padding) return;
  const ClearanceView view{
      .cells = clearance_.data(), .width = width_, .height = height_, .resolution = resolution_};
  glocal::find_blocked(view, grid_from_map_(from), ends, map_from_ends, grid_from_map_,
                       static_cast<float>(margin), blocked);
}

std::shared_ptr<const ClearanceGrid> clearance_grid(const GlobalMap& map) {
  return map.index<ClearanceGrid>("", [&] { return ClearanceGrid(map.grid()); });
}

}  // namespace glocal
