#include "glocal/occupancy_grid.hpp"

#include <cmath>

namespace glocal {

Cell OccupancyGrid::at(double map_x, double map_y) const {
  const Pose2 p = inverse(map_from_grid) * Pose2{map_x, map_y, 0.0};
  const double column = std::floor(p.x / resolution);
  const double row = std::floor(p.y / resolution);
  // Negated so that NaN falls outside.
  if (!(column >= 0.0 && column < width && row >= 0.0 && row < height)) return Cell::unknown;
  return cell(static_cast<int>(column), static_cast<int>(row));
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
