#include "sources/simulation/occupancy_ray.hpp"

#include "sources/grid_ray.hpp"

namespace glocal::simulation {

double ray_distance(const OccupancyGrid& grid, const Position& origin, const Position& direction,
                    double reach, double max_unknown, double thing) {
  const Pose2 grid_from_map = inverse(grid.map_from_grid);
  const Pose2 start = grid_from_map * Pose2{origin[0], origin[1], 0.0};
  const Pose2 end =
      grid_from_map * Pose2{origin[0] + reach * direction[0], origin[1] + reach * direction[1], 0.0};
  double distance = thing <= reach ? thing : std::numeric_limits<double>::infinity();
  Cell last_cell = Cell::free;
  double unknown_from = 0.0;  // share of the ray where the present unknown cells begin
  const auto is_lost = [&](double share) {
    return last_cell == Cell::unknown && (share - unknown_from) * reach > max_unknown;
  };
  const auto look = [&](int column, int row, double share) {
    if (is_lost(share) || share * reach >= distance) return false;
    const Cell cell = grid.holds(column, row) ? grid.cell(column, row) : Cell::unknown;
    if (cell == Cell::unknown && last_cell != Cell::unknown) unknown_from = share;
    last_cell = cell;
    if (cell == Cell::occupied) distance = share * reach;
    return cell != Cell::occupied;
  };
  visit_cells_before_end(start.x / grid.resolution, start.y / grid.resolution, end.x / grid.resolution,
                         end.y / grid.resolution, look);
  // Up to the thing, which may stand within the last cells.
  return is_lost(distance / reach) ? std::numeric_limits<double>::quiet_NaN() : distance;
}

}  // namespace glocal::simulation
