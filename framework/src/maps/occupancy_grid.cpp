#include "glocal/occupancy_grid.hpp"

#include <cmath>

#include "maps/look_up.hpp"

namespace glocal {

Cell OccupancyGrid::at(double map_x, double map_y) const {
  const Pose2 p = inverse(map_from_grid) * Pose2{map_x, map_y, 0.0};
  const double column = std::floor(p.x / resolution);
  const double row = std::floor(p.y / resolution);
  // Negated so that NaN falls outside.
  if (!(column >= 0.0 && column < width && row >= 0.0 && row < height)) return Cell::unknown;
  return cell(static_cast<int>(column), static_cast<int>(row));
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
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.cell(column, row) != Cell::occupied) continue;
      const Pose2 centre = grid.centre(column, row);
      points.push_back({static_cast<float>(centre.x), static_cast<float>(centre.y), 0.0F});
    }
  }
  return points;
}

}  // namespace glocal
