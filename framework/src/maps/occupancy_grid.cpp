#include "glocal/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>

#include "maps/look_up.hpp"

namespace glocal {

PackedCells::PackedCells(std::size_t size, Cell cell)
    : size_(size), words_((size + per_word - 1) / per_word) {
  fill(0, size, cell);
}

PackedCells::PackedCells(std::initializer_list<Cell> cells) : PackedCells(cells.size()) {
  std::copy(cells.begin(), cells.end(), begin());
}

void PackedCells::fill(std::size_t begin, std::size_t n, Cell cell) {
  const std::size_t end = begin + n;
  for (std::size_t i = begin; i < end;) {
    const std::size_t next = std::min(end, (i / per_word + 1) * per_word);
    const std::uint64_t filled = ~std::uint64_t{0} >> (64 - bits * (next - i)) << shift_of(i);
    std::uint64_t& word = words_[i / per_word];
    word = (word & ~filled) | (all(cell) & filled);
    i = next;
  }
}

Cell OccupancyGrid::at(double map_x, double map_y) const {
  return CellsAt(*this)(map_x, map_y);
}

CellsAt::CellsAt(const OccupancyGrid& grid)
    : grid_(grid),
      grid_from_map_(inverse(grid.map_from_grid)),
      cosine_(std::cos(grid_from_map_.theta)),
      sine_(std::sin(grid_from_map_.theta)) {}

Cell CellsAt::operator()(double map_x, double map_y) const {
  const double x = grid_from_map_.x + cosine_ * map_x - sine_ * map_y;
  const double y = grid_from_map_.y + sine_ * map_x + cosine_ * map_y;
  const double column = std::floor(x / grid_.resolution);
  const double row = std::floor(y / grid_.resolution);
  // Negated so that NaN falls outside.
  if (!(column >= 0.0 && column < grid_.width && row >= 0.0 && row < grid_.height)) return Cell::unknown;
  return grid_.cell(static_cast<int>(column), static_cast<int>(row));
}

CellsUnder::CellsUnder(const OccupancyGrid& grid, const Pose2& map_from_points)
    : grid_(grid),
      grid_from_points_(inverse(grid.map_from_grid) * map_from_points),
      scale_(grid.resolution > 0.0 ? static_cast<float>(1.0 / grid.resolution) : 0.0F) {}

Cell CellsUnder::operator()(const Point& p) const {
  const Point in_grid = grid_from_points_(p);
  const float column = in_grid.x * scale_;
  const float row = in_grid.y * scale_;
  const bool inside = column >= 0.0F && row >= 0.0F && column < static_cast<float>(grid_.width) &&
                      row < static_cast<float>(grid_.height);
  return inside ? grid_.cell(static_cast<int>(column), static_cast<int>(row)) : Cell::unknown;
}

void CellsUnder::find(const Points& points, std::vector<Cell>& cells) const {
  cells.resize(points.size());
  find_cells(grid_, scale_, points, grid_from_points_, cells);
}

Points occupied_centres(const OccupancyGrid& grid) {
  Points points;
  std::size_t occupied = 0;
  grid.cells.for_occupied(0, grid.cells.size(), [&](std::size_t /*cell*/) { ++occupied; });
  points.reserve(occupied);
  const double c = std::cos(grid.map_from_grid.theta);
  const double s = std::sin(grid.map_from_grid.theta);
  for (int row = 0; row < grid.height; ++row) {
    const std::size_t begin = grid.index(0, row);
    const double y = (row + 0.5) * grid.resolution;
    grid.cells.for_occupied(begin, grid.index(0, row + 1), [&](std::size_t cell) {
      const double x = (static_cast<double>(cell - begin) + 0.5) * grid.resolution;
      points.push_back({static_cast<float>(grid.map_from_grid.x + c * x - s * y),
                        static_cast<float>(grid.map_from_grid.y + s * x + c * y), 0.0F});
    });
  }
  return points;
}

}  // namespace glocal
