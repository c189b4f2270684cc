#include "sources/random_scans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "glocal/error.hpp"
#include "sources/grid_ray.hpp"

namespace glocal {
namespace {

enum Stream : std::uint64_t { pose_stream, laser_stream };

/// Marks the cells nearer to one than `reach`, border to border, in cells.
void mark_around(int column, int row, double reach, const OccupancyGrid& grid, std::vector<char>& marks) {
  const int cells = static_cast<int>(std::ceil(reach));
  for (int r = std::max(row - cells, 0); r <= std::min(row + cells, grid.height - 1); ++r) {
    for (int c = std::max(column - cells, 0); c <= std::min(column + cells, grid.width - 1); ++c) {
      const int between_columns = std::max(std::abs(c - column) - 1, 0);
      const int between_rows = std::max(std::abs(r - row) - 1, 0);
      if (std::hypot(between_columns, between_rows) < reach) marks[grid.index(c, r)] = 1;
    }
  }
}

/// Free cells of which every place is at least `clearance` (m) away from every cell that is not free. What
/// lies outside of the grid is not free either.
std::vector<std::size_t> clear_cells(const OccupancyGrid& grid, double clearance) {
  const auto is_free = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < grid.width && row < grid.height &&
           grid.cell(column, row) == Cell::free;
  };
  std::vector<char> marks(grid.cells.size(), 0);
  for (int row = -1; row <= grid.height; ++row) {
    for (int column = -1; column <= grid.width; ++column) {
      // Others are farther from any free cell than one of these.
      const bool borders_on_free = is_free(column - 1, row) || is_free(column + 1, row) ||
                                   is_free(column, row - 1) || is_free(column, row + 1);
      if (!is_free(column, row) && borders_on_free)
        mark_around(column, row, clearance / grid.resolution, grid, marks);
    }
  }
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (grid.cells[i] == Cell::free && marks[i] == 0) cells.push_back(i);
  }
  return cells;
}

}  // namespace

double ray_distance(const OccupancyGrid& grid, const Position& origin, const Position& direction,
                    double reach, double max_unknown) {
  const Pose2 grid_from_map = inverse(grid.map_from_grid);
  const Pose2 start = grid_from_map * Pose2{origin[0], origin[1], 0.0};
  const Pose2 end =
      grid_from_map * Pose2{origin[0] + reach * direction[0], origin[1] + reach * direction[1], 0.0};
  double distance = std::numeric_limits<double>::infinity();
  Cell last_cell = Cell::free;
  double unknown_from = 0.0;  // share of the ray where the present unknown cells begin
  const auto look = [&](int column, int row, double share) {
    const bool inside = column >= 0 && row >= 0 && column < grid.width && row < grid.height;
    const Cell cell = inside ? grid.cell(column, row) : Cell::unknown;
    if (last_cell == Cell::unknown && (share - unknown_from) * reach > max_unknown) return false;
    if (cell == Cell::unknown && last_cell != Cell::unknown) unknown_from = share;
    last_cell = cell;
    if (cell == Cell::occupied) distance = share * reach;
    return cell != Cell::occupied;
  };
  visit_cells_before_end(start.x / grid.resolution, start.y / grid.resolution, end.x / grid.resolution,
                         end.y / grid.resolution, look);
  return last_cell == Cell::unknown ? std::numeric_limits<double>::quiet_NaN() : distance;
}

void describe(ParamVisitor& v, RandomScans::Params& p) {
  describe(v, p.map);
  v.field("count", p.count, {.doc = "How many scans.", .min = 1, .max = 1e6});
  v.field("clearance", p.clearance,
          {.doc = "Poses are at least so far away from every cell that is not free.",
           .unit = "m",
           .min = 0.0,
           .max = 5.0,
           .audience = Audience::expert});
  v.field("max_unknown", p.max_unknown,
          {.doc = "Farthest a ray may go through unknown cells before it reaches an occupied one, as walls "
                  "have blurred rims. A ray that goes farther gives no reading.",
           .unit = "m",
           .min = 0.0,
           .audience = Audience::expert});
  v.field("laser", p.laser, {.doc = "The range finder. Rays end where they enter an occupied cell."});
}

RandomScans::RandomScans(const Params& params, const SourceSetup& setup)
    : params_(params),
      grid_(RosMap(params.map, setup).load().grid),
      clear_cells_(clear_cells(grid_, params.clearance)),
      scan_limits_(scan_limits(params.laser)),
      rng_(setup.seed) {
  if (!clear_cells_.empty()) return;
  throw ConfigError({{params.map.path.resolved.string(), 0, 0,
                      fmt::format("has no free cell {} m away from all that is not free; lower clearance, or "
                                  "take another map",
                                  params.clearance)}});
}

Pose2 RandomScans::draw_pose() const {
  Rng rng = rng_.stream({pose_stream, next_});
  const std::size_t cell = clear_cells_[rng.below(static_cast<std::uint32_t>(clear_cells_.size()))];
  const std::size_t column = cell % static_cast<std::size_t>(grid_.width);
  const std::size_t row = cell / static_cast<std::size_t>(grid_.width);
  const double x = (static_cast<double>(column) + rng.uniform()) * grid_.resolution;
  const double y = (static_cast<double>(row) + rng.uniform()) * grid_.resolution;
  return grid_.map_from_grid * Pose2{x, y, rng.uniform(-std::numbers::pi, std::numbers::pi)};
}

std::optional<Sample> RandomScans::next() {
  if (next_ == static_cast<std::size_t>(params_.count)) return std::nullopt;
  const Pose2 map_from_robot = draw_pose();
  // Looked at from beyond the last cell that matters, as rays stop before the cell they end in.
  const double reach = params_.laser.max_range + 2.0 * grid_.resolution;
  const auto distance_to_cells = [&](const Position& origin, const Position& direction) {
    return ray_distance(grid_, origin, direction, reach, params_.max_unknown);
  };
  const CarmenScan scan =
      simulated_scan(params_.laser, map_from_robot, distance_to_cells, rng_.stream({laser_stream, next_}));
  const Observation observation{static_cast<double>(next_), robot_scan(scan, scan_limits_), {}};
  return Sample{observation, map_from_robot, static_cast<int>(next_++)};
}

}  // namespace glocal
