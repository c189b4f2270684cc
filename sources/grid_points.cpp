#include "sources/grid_points.hpp"

namespace glocal {

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
