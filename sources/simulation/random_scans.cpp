#include "sources/simulation/random_scans.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "glocal/error.hpp"
#include "sources/simulation/clear_cells.hpp"
#include "sources/simulation/occupancy_ray.hpp"

namespace glocal::simulation {
namespace {

enum Stream : std::uint64_t { pose_stream, laser_stream };

/// Their indexes.
std::vector<std::size_t> marked(const std::vector<char>& marks) {
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] != 0) cells.push_back(i);
  }
  return cells;
}

}  // namespace

void describe(ParamVisitor& v, RandomScans::Params& p) {
  describe(v, p.map);
  v.field("count", p.count, {.doc = "How many scans.", .min = 1, .max = 1e6});
  v.field("clearance", p.clearance,
          {.doc = "Poses are at least so far away from every cell that is not free.",
           .unit = "m",
           .min = 0.0,
           .max = 5.0,
           .audience = Audience::expert});
  v.field("laser", p.laser, {.doc = "The range finder. Rays end where they enter an occupied cell."});
}

RandomScans::RandomScans(const Params& params, const SourceSetup& setup)
    : RandomScans(params, ros_map::RosMap(params.map, setup).load(), setup.seed) {}

RandomScans::RandomScans(const Params& params, MapData map, std::uint64_t seed)
    : params_(params),
      map_(std::move(map)),
      clear_cells_(marked(clear_cells(map_.grid, params.clearance))),
      scan_limits_(scan_limits(params.laser)),
      rng_(seed) {
  if (!clear_cells_.empty()) return;
  throw ConfigError(params.map.path.resolved,
                    fmt::format("has no free cell {} m away from all that is not free; lower clearance, or "
                                "take another map",
                                params.clearance));
}

Pose2 RandomScans::draw_pose() const {
  Rng rng = rng_.stream({pose_stream, next_});
  const std::size_t cell = clear_cells_[rng.below(static_cast<std::uint32_t>(clear_cells_.size()))];
  const OccupancyGrid& grid = map_.grid;
  const std::size_t column = cell % static_cast<std::size_t>(grid.width);
  const std::size_t row = cell / static_cast<std::size_t>(grid.width);
  const double x = (static_cast<double>(column) + rng.uniform()) * grid.resolution;
  const double y = (static_cast<double>(row) + rng.uniform()) * grid.resolution;
  return grid.map_from_grid * Pose2{x, y, rng.uniform(-std::numbers::pi, std::numbers::pi)};
}

std::optional<Sample> RandomScans::next() {
  if (next_ == static_cast<std::size_t>(params_.count)) return std::nullopt;
  const Pose2 map_from_robot = draw_pose();  // Relative to the map's origin.
  // Looked at from beyond the last cell that matters, as rays stop before the cell they end in.
  const double reach = params_.laser.max_range + 2.0 * map_.grid.resolution;
  const auto distance_to_cells = [&](const Position& origin, const Position& direction) {
    return ray_distance(map_.grid, origin, direction, reach, params_.max_unknown);
  };
  const carmen::CarmenScan scan =
      simulated_scan(params_.laser, map_from_robot, distance_to_cells, rng_.stream({laser_stream, next_}));
  const Observation observation{static_cast<double>(next_), carmen::robot_scan(scan, scan_limits_), {}};
  return Sample{observation, shifted(map_from_robot, map_.origin), static_cast<int>(next_++)};
}

}  // namespace glocal::simulation
