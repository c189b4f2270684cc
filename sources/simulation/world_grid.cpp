#include "sources/simulation/world_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "sources/clouds/cloud_file.hpp"
#include "sources/simulation/clear_cells.hpp"

namespace glocal::simulation {
namespace {

using clouds::CloudVoxels;

constexpr double fine_resolution = 0.05;  // m
constexpr double most_cells = 4e6;        // of reality, by which nothing is measured
// Of a cloud, m:
constexpr double near_places = 10.0;     // what is farther away is hardly seen
constexpr double floor_tolerance = 0.2;  // uneven ground, thresholds, cables
constexpr double floor_gap = 0.5;        // between points of a floor
constexpr double headroom = 2.0;         // for people
constexpr double walker_radius = 0.2;    // of people

/// A grid to draw on.
class Raster {
 public:
  /// `first` is the centre of the first cell; the last one is around the place `last`.
  Raster(const Position& first, const Position& last, double resolution) : first_(first) {
    grid_.map_from_grid = {first[0] - resolution / 2.0, first[1] - resolution / 2.0, 0.0};
    grid_.resolution = resolution;
    grid_.width = column_of(last[0]) + 1;
    grid_.height = row_of(last[1]) + 1;
    grid_.cells = PackedCells(static_cast<std::size_t>(grid_.width) * static_cast<std::size_t>(grid_.height));
  }

  void draw(const Shapes& shapes) {
    for (const Segment& segment : shapes.segments) draw(segment);
    for (const Circle& circle : shapes.circles) draw(circle);
  }

  /// Without gaps, and one cell thick: one cell for each column of a flat line, or row of a steep one.
  void draw(const Segment& s) {
    const int steps = std::max(std::abs(column_of(s.to[0]) - column_of(s.from[0])),
                               std::abs(row_of(s.to[1]) - row_of(s.from[1])));
    for (int i = 0; i <= steps; ++i)
      mark(between(s.from, s.to, steps == 0 ? 0.0 : static_cast<double>(i) / steps));
  }

  void draw(const Circle& c) {
    const int steps =
        static_cast<int>(std::ceil(2.0 * std::numbers::pi * c.radius / (0.5 * grid_.resolution)));
    for (int i = 0; i < steps; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / steps;
      mark({c.centre[0] + c.radius * std::cos(angle), c.centre[1] + c.radius * std::sin(angle)});
    }
  }

  /// Frees everything that can be reached from a place without crossing an outline, run by run: what is still
  /// to be looked at would else take more memory than the grid. False if there is nothing to free.
  bool flood(const Position& from) {
    std::vector<std::array<int, 2>> open{{column_of(from[0]), row_of(from[1])}};
    if (!is_unknown(open[0][0], open[0][1])) return false;
    while (!open.empty()) {
      const auto [column, row] = open.back();
      open.pop_back();
      if (!is_unknown(column, row)) continue;
      int first = column;
      int last = column;
      while (is_unknown(first - 1, row)) --first;
      while (is_unknown(last + 1, row)) ++last;
      for (int i = first; i <= last; ++i) grid_.cell(i, row) = Cell::free;
      for (const int beside : {row - 1, row + 1}) {
        for (int i = first; i <= last; ++i) {
          const bool begins_run = is_unknown(i, beside) && (i == first || !is_unknown(i - 1, beside));
          if (begins_run) open.push_back({i, beside});
        }
      }
    }
    return true;
  }

  void forget(const UnmappedArea& area) {
    const auto [left, right] = std::minmax(area.corners[0][0], area.corners[1][0]);
    const auto [low, high] = std::minmax(area.corners[0][1], area.corners[1][1]);
    for (int row = std::max(row_of(low), 0); row <= std::min(row_of(high), grid_.height - 1); ++row) {
      for (int column = std::max(column_of(left), 0); column <= std::min(column_of(right), grid_.width - 1);
           ++column) {
        grid_.cell(column, row) = Cell::unknown;
      }
    }
  }

  /// Nothing gets to cells without a mark.
  void keep_to(const std::vector<char>& marks) {
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (marks[i] == 0) grid_.cells[i] = Cell::occupied;
    }
  }

  [[nodiscard]] const OccupancyGrid& grid() const { return grid_; }
  [[nodiscard]] OccupancyGrid take() { return std::move(grid_); }

 private:
  [[nodiscard]] int column_of(double x) const { return nearest(x - first_[0]); }
  [[nodiscard]] int row_of(double y) const { return nearest(y - first_[1]); }
  [[nodiscard]] int nearest(double metres) const {
    return static_cast<int>(std::floor(metres / grid_.resolution + 0.5));
  }
  [[nodiscard]] bool is_unknown(int column, int row) const {
    return grid_.holds(column, row) && grid_.cell(column, row) == Cell::unknown;
  }
  void mark(const Position& place) {
    const int column = column_of(place[0]), row = row_of(place[1]);
    if (grid_.holds(column, row)) grid_.cell(column, row) = Cell::occupied;
  }

  Position first_;
  OccupancyGrid grid_;
};

/// Of all that lies within a world's size: cells are centred on multiples of their side.
Raster drawn(const World& world, const Shapes& shapes, double resolution) {
  Raster raster({0.0, 0.0}, {world.size[0], world.size[1]}, resolution);
  raster.draw(shapes);
  return raster;
}

/// A cell for each column of voxels around some places.
Raster raster_around(const std::vector<Position>& places, const CloudVoxels& cloud, const std::string& file) {
  Bounds bounds;
  for (const Position& place : places) bounds.add(place, near_places);
  const auto& [low, high] = bounds;
  const double side = cloud.side();
  constexpr double most_columns = 64e6;
  if (!((high[0] - low[0]) / side * ((high[1] - low[1]) / side) <= most_columns))
    throw ConfigError(file,
                      fmt::format("cloud: the drive leads past more than 64 million columns of voxels of {} "
                                  "m; leave out boxes and people, drive less far, or take larger voxels",
                                  side));
  const Vector3 first = cloud.centre_near({low[0], low[1], 0.0});
  return {{first.x(), first.y()}, high, side};
}

enum class Ground { none, floor, thing };

/// What a column of voxels is to somebody who stands in it.
Ground ground_at(const Position& place, const CloudVoxels& cloud, double floor) {
  const double margin = floor_tolerance + cloud.side() / 2.0;  // of a voxel's centre
  const double top = floor + headroom + cloud.side() / 2.0;
  Ground ground = Ground::none;
  for (Vector3 at = cloud.centre_near({place[0], place[1], floor - margin}); at.z() < top;
       at.z() += cloud.side()) {
    if (at.z() < floor - margin || !cloud.is_occupied(at)) continue;
    if (at.z() > floor + margin) return Ground::thing;
    ground = Ground::floor;
  }
  return ground;
}

/// Marks what lies between marked cells, too: grows the marks, then shrinks them by as much. Of `within`
/// only.
std::vector<char> gaps_closed(const std::vector<char>& marks, const std::vector<char>& within,
                              const OccupancyGrid& grid) {
  std::vector<char> outside = grown(marks, floor_gap / 2.0, grid);
  for (std::size_t i = 0; i < outside.size(); ++i) outside[i] = within[i] != 0 && outside[i] == 0 ? 1 : 0;
  std::vector<char> closed = grown(outside, floor_gap / 2.0, grid);
  for (std::size_t i = 0; i < closed.size(); ++i) closed[i] = within[i] != 0 && closed[i] == 0 ? 1 : 0;
  return closed;
}

/// Marks the cells of `within` that are over a floor of the cloud, and have nothing else over it.
std::vector<char> cells_over_floor(const OccupancyGrid& grid, const std::vector<char>& within,
                                   const CloudVoxels& cloud, double floor) {
  std::vector<char> is_floor(grid.cells.size(), 0), is_thing(grid.cells.size(), 0);
  for_each_cell(grid, [&](int column, int row) {
    const std::size_t cell = grid.index(column, row);
    if (within[cell] == 0) return;
    const Pose2 centre = grid.centre(column, row);
    const Ground ground = ground_at({centre.x, centre.y}, cloud, floor);
    is_floor[cell] = ground == Ground::floor ? 1 : 0;
    is_thing[cell] = ground == Ground::thing ? 1 : 0;
  });
  std::vector<char> is_over_floor = gaps_closed(is_floor, within, grid);
  for (std::size_t i = 0; i < is_thing.size(); ++i) {
    if (is_thing[i] != 0) is_over_floor[i] = 0;
  }
  return is_over_floor;
}

}  // namespace

OccupancyGrid plan_of(const World& world, double resolution, const std::string& origin) {
  const double whole_area = world.size[0] * world.size[1];
  if (!(whole_area / resolution / resolution <= max_grid_cells)) {
    throw ConfigError(
        origin,
        fmt::format("its map would have more than 1000 million cells of {} m; raise resolution to {} or more",
                    resolution, std::ceil(std::sqrt(whole_area / max_grid_cells) * 100.0) / 100.0));
  }
  Raster raster = drawn(world, shapes_on_map(world), resolution);
  for (const Position& place : world.free_from) raster.flood(place);
  for (const UnmappedArea& area : world.unmapped) raster.forget(area);
  return raster.take();
}

OccupancyGrid reality_of(const World& world) {
  const double coarse_resolution = std::sqrt(world.size[0] * world.size[1] / most_cells);
  Raster raster = drawn(world, shapes_in_reality(world), std::max(fine_resolution, coarse_resolution));
  // Cells of large worlds are so coarse that the first way points may lie in those of a wall.
  for (const Position& place : world.way_points) {
    if (raster.flood(place)) break;
  }
  return raster.take();
}

CloudVoxels voxels_of(const World& world) {
  const std::filesystem::path& file = world.cloud.resolved;
  return {clouds::read_cloud(file), world.cloud_voxel_size, file.string()};
}

OccupancyGrid floor_near(const std::vector<Position>& places, const World& world, const CloudVoxels& cloud,
                         const std::string& file) {
  Raster raster = raster_around(places, cloud, file);
  std::vector<char> is_place(raster.grid().cells.size(), 0);
  for (const Position& place : places) is_place[*cell_under(place, raster.grid())] = 1;
  const std::vector<char> is_near = grown(is_place, near_places, raster.grid());
  const std::vector<char> is_over_floor = cells_over_floor(raster.grid(), is_near, cloud, world.floor);
  if (std::ranges::find(is_over_floor, 1) == is_over_floor.end())
    throw ConfigError(file,
                      fmt::format("cloud: has no points within {} m of the floor of {} m near the drive, so "
                                  "that boxes and people have nothing to stand on; change floor, leave them "
                                  "out, or list them in the file of the world",
                                  floor_tolerance, world.floor));
  raster.keep_to(is_over_floor);
  raster.draw(shapes_in_reality(world));
  OccupancyGrid floor = raster.grid();
  std::replace(floor.cells.begin(), floor.cells.end(), Cell::unknown, Cell::free);
  // Walls of points have holes that nobody walks through.
  raster.keep_to(clear_cells(floor, walker_radius));
  for (const Position& place : places) raster.flood(place);
  std::vector<char> is_reached(floor.cells.size());
  for (std::size_t i = 0; i < is_reached.size(); ++i)
    is_reached[i] = raster.grid().cells[i] == Cell::free ? 1 : 0;
  is_reached = grown(is_reached, walker_radius, floor);
  for (std::size_t i = 0; i < is_reached.size(); ++i) {
    if (floor.cells[i] == Cell::free && is_reached[i] == 0) floor.cells[i] = Cell::unknown;
  }
  return floor;
}

}  // namespace glocal::simulation
