#include "sources/carmen/log_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "sources/grid_ray.hpp"

namespace glocal::carmen {
namespace {

/// A scan and the sensor's place on the map.
struct PlacedScan {
  Pose2 map_from_robot;
  Scan scan;
};

struct Count {
  std::uint32_t hits = 0;
  std::uint32_t passes = 0;
  float sum_x = 0.0F;  ///< Of the hits, from the cell's corner.
  float sum_y = 0.0F;
};

std::vector<PlacedScan> placed_scans(const LogDrive& drive, const LogMap::Params& params) {
  const std::string file = params.log.path.resolved.string();
  std::vector<PlacedScan> placed;
  placed.reserve(drive.frames.size());
  for (const LogFrame& frame : drive.frames) {
    const CarmenScan& scan = drive.scans[frame.scan];
    if (!scan.map_from_robot) {
      throw ConfigError(
          {{file, scan.line, 0,
            "this scan has no reference pose; a map needs a TRUEPOS line before each scan it is made "
            "from"}});
    }
    placed.push_back({*scan.map_from_robot, robot_scan(scan, params.log)});
  }
  return placed;
}

/// Makes the places of scans relative to an origin near the first one, and answers it.
Vector3 take_origin_from(std::vector<PlacedScan>& placed) {
  if (placed.empty()) return Vector3::Zero();
  const Pose2 first = placed.front().map_from_robot;
  Vector3 origin = origin_near({first.x, first.y, 0.0});
  for (PlacedScan& p : placed) {
    p.map_from_robot.x -= origin.x();
    p.map_from_robot.y -= origin.y();
  }
  return origin;
}

Eigen::AlignedBox2d extent(const std::vector<PlacedScan>& placed) {
  Eigen::AlignedBox2d box;
  const auto include = [&](const Point& p) { box.extend(Eigen::Vector2d(p.x, p.y)); };
  for (const PlacedScan& p : placed) {
    const Transform map_from_robot(p.map_from_robot);
    include(map_from_robot(p.scan.origin));
    for (std::size_t i = 0; i < p.scan.hits.size(); ++i) include(map_from_robot(p.scan.hits[i]));
    for (std::size_t i = 0; i < p.scan.free_ends.size(); ++i) include(map_from_robot(p.scan.free_ends[i]));
  }
  return box;
}

/// The multiple of the resolution that is next to a coordinate, and not above it.
double multiple_below(double coordinate, double resolution) {
  const double multiple = std::floor(coordinate / resolution) * resolution;
  // The product may be rounded up: 0.7 * floor(-31.5 / 0.7) is above -31.5.
  return multiple > coordinate ? multiple - resolution : multiple;
}

OccupancyGrid make_grid(const Eigen::AlignedBox2d& box, double resolution, const std::string& file) {
  const double x = multiple_below(box.min().x(), resolution);
  const double y = multiple_below(box.min().y(), resolution);
  const double width = std::floor((box.max().x() - x) / resolution) + 1.0;
  const double height = std::floor((box.max().y() - y) / resolution) + 1.0;
  constexpr double most_counted = 64e6;
  if (!(width * height <= most_counted)) {
    throw ConfigError(
        file,
        "its map would have more than 64 million cells; raise resolution, lower max_range, or look for "
        "wrong reference poses");
  }
  OccupancyGrid grid{{x, y, 0.0}, resolution, static_cast<int>(width), static_cast<int>(height), {}};
  grid.cells = PackedCells(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  return grid;
}

/// Counts the hits and passes of scans over a grid that holds them all.
class Counter {
 public:
  explicit Counter(const OccupancyGrid& grid) : grid_(grid), counts_(grid.cells.size()) {}

  void add(const PlacedScan& placed) {
    const Transform map_from_robot(placed.map_from_robot);
    const Point origin = map_from_robot(placed.scan.origin);
    for (std::size_t i = 0; i < placed.scan.hits.size(); ++i) {
      const Point hit = map_from_robot(placed.scan.hits[i]);
      pass(origin, hit);
      count_hit(hit);
    }
    for (std::size_t i = 0; i < placed.scan.free_ends.size(); ++i) {
      pass(origin, map_from_robot(placed.scan.free_ends[i]));
    }
  }

  [[nodiscard]] const std::vector<Count>& counts() const { return counts_; }

 private:
  [[nodiscard]] double column(float x) const { return (x - grid_.map_from_grid.x) / grid_.resolution; }
  [[nodiscard]] double row(float y) const { return (y - grid_.map_from_grid.y) / grid_.resolution; }
  [[nodiscard]] Count& at(int column, int row) { return counts_[grid_.index(column, row)]; }

  void pass(const Point& from, const Point& to) {
    visit_cells_before_end(column(from.x), row(from.y), column(to.x), row(to.y),
                           [this](int c, int r, double /*share*/) {
                             ++at(c, r).passes;
                             return true;
                           });
  }

  void count_hit(const Point& hit) {
    const double c = column(hit.x);
    const double r = row(hit.y);
    Count& count = at(static_cast<int>(c), static_cast<int>(r));
    ++count.hits;
    count.sum_x += static_cast<float>((c - std::floor(c)) * grid_.resolution);
    count.sum_y += static_cast<float>((r - std::floor(r)) * grid_.resolution);
  }

  const OccupancyGrid& grid_;
  std::vector<Count> counts_;
};

Cell classify(const Count& count, const LogMap::Params& params) {
  const auto hits = static_cast<double>(count.hits);
  const double share = hits / std::max(hits + count.passes, 1.0);
  if (hits >= params.min_hits && share >= params.min_hit_share) return Cell::occupied;
  return count.passes > 0 ? Cell::free : Cell::unknown;
}

/// The mean of the hits, which is closer to the wall than the cell's centre.
Point point_of(const OccupancyGrid& grid, int column, int row, const Count& count) {
  const auto hits = static_cast<float>(count.hits);
  return {static_cast<float>(grid.map_from_grid.x + column * grid.resolution) + count.sum_x / hits,
          static_cast<float>(grid.map_from_grid.y + row * grid.resolution) + count.sum_y / hits, 0.0F};
}

std::vector<Pose3> path_of(const std::vector<PlacedScan>& placed) {
  std::vector<Pose3> path;
  for (const PlacedScan& p : placed) path.push_back(p.map_from_robot);
  return sparse_path(path);
}

}  // namespace

LogMap::Params::Params() {
  log.keyframes = {0.0, 0.0};
}

void describe(ParamVisitor& v, LogMap::Params& p) {
  describe_frames(v, p.log);
  v.require(p.log.min_range < p.log.max_range, "max_range",
            "must be above 0.1 m: nearer readings are dropped");
  v.field("resolution", p.resolution,
          {.doc = "Side of a cell.", .unit = "m", .min = least_resolution, .max = 10.0});
  v.field("min_hits", p.min_hits,
          {.doc = "A cell is occupied only if at least so many readings end in it.",
           .min = 1,
           .audience = Audience::tuner});
}

LogMap::LogMap(const Params& params, const SourceSetup& setup) : params_(params) {
  setup.note_input(params.log.path.resolved);
}

MapData LogMap::load() {
  const std::string file = params_.log.path.resolved.string();
  std::vector<PlacedScan> placed = placed_scans(read_log_drive(params_.log), params_);
  MapData map;
  map.origin = take_origin_from(placed);
  map.grid = make_grid(extent(placed), params_.resolution, file);
  Counter counter(map.grid);
  for (const PlacedScan& p : placed) counter.add(p);
  for_each_cell(map.grid, [&](int column, int row) {
    const Count& count = counter.counts()[map.grid.index(column, row)];
    PackedCells::Reference cell = map.grid.cell(column, row);
    cell = classify(count, params_);
    if (cell == Cell::occupied) map.points.push_back(point_of(map.grid, column, row, count));
  });
  if (map.points.empty()) {
    throw ConfigError(file, "its map has no occupied cell; lower min_hits, or use more scans");
  }
  map.path = path_of(placed);
  return map;
}

}  // namespace glocal::carmen
