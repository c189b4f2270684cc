// All kinds of disturbances of maps, and what is written down of their levels.
#include "sources/disturbed/map_disturbances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "glocal/extent.hpp"

namespace glocal::disturbed {
namespace {

/// Connected occupied cells that are not larger than this along either axis are furniture, m.
constexpr double largest_furniture = 2.0;
/// Walls go by the block, m.
constexpr double block = 1.0;

/// The points of a map whose cells have changed. Their normals are not known any more.
void take_points_of_cells(MapData& map) {
  map.points = occupied_centres(map.grid);
  map.normals = {};
}

/// Cells of a grid by column and row.
struct CellAt {
  int column = 0, row = 0;
};

/// Groups of occupied cells that touch, by sides or corners, in the order of their first cells.
std::vector<std::vector<CellAt>> components_of(const OccupancyGrid& grid) {
  std::vector<char> seen(grid.cells.size(), 0);
  std::vector<std::vector<CellAt>> components;
  for_each_cell(grid, [&](int column, int row) {
    if (grid.cell(column, row) != Cell::occupied || seen[grid.index(column, row)] != 0) return;
    seen[grid.index(column, row)] = 1;
    std::vector<CellAt> component{{column, row}};
    for (std::size_t i = 0; i < component.size(); ++i) {
      const CellAt at = component[i];
      for (int y = std::max(at.row - 1, 0); y <= std::min(at.row + 1, grid.height - 1); ++y) {
        for (int x = std::max(at.column - 1, 0); x <= std::min(at.column + 1, grid.width - 1); ++x) {
          if (grid.cell(x, y) != Cell::occupied || seen[grid.index(x, y)] != 0) continue;
          seen[grid.index(x, y)] = 1;
          component.push_back({x, y});
        }
      }
    }
    components.push_back(std::move(component));
  });
  return components;
}

/// The cells of a component at its ends.
struct Ends {
  CellAt least, most;
};

Ends ends_of(const std::vector<CellAt>& component) {
  const auto [left, right] = std::minmax_element(component.begin(), component.end(),
                                                 [](CellAt a, CellAt b) { return a.column < b.column; });
  const auto [low, high] = std::minmax_element(component.begin(), component.end(),
                                               [](CellAt a, CellAt b) { return a.row < b.row; });
  return {{left->column, low->row}, {right->column, high->row}};
}

/// This share of the furniture, drawn.
std::vector<std::vector<CellAt>> some_furniture(const OccupancyGrid& grid, double share, Rng& rng) {
  std::vector<std::vector<CellAt>> chosen;
  for (std::vector<CellAt>& component : components_of(grid)) {
    const auto [least, most] = ends_of(component);
    const bool is_furniture = (most.column - least.column + 1) * grid.resolution <= largest_furniture &&
                              (most.row - least.row + 1) * grid.resolution <= largest_furniture;
    if (is_furniture && rng.uniform() < share) chosen.push_back(std::move(component));
  }
  return chosen;
}

/// What becomes of a share of the furniture: taken away, or put up to `farthest` metres away, where that is
/// free.
void move_furniture(MapData& map, double share, double farthest, Rng& rng) {
  OccupancyGrid& grid = map.grid;
  const auto chosen = some_furniture(grid, share, rng);
  for (const std::vector<CellAt>& component : chosen) {
    for (const CellAt at : component) grid.cell(at.column, at.row) = Cell::free;
  }
  if (farthest > 0.0) {
    const double reach = farthest / grid.resolution;
    for (const std::vector<CellAt>& component : chosen) {
      const auto right = static_cast<int>(std::lround(rng.uniform(-reach, reach)));
      const auto up = static_cast<int>(std::lround(rng.uniform(-reach, reach)));
      for (const CellAt at : component) {
        const CellAt to{at.column + right, at.row + up};
        if (grid.holds(to.column, to.row) && grid.cell(to.column, to.row) == Cell::free)
          grid.cell(to.column, to.row) = Cell::occupied;
      }
    }
  }
  take_points_of_cells(map);
}

void take_furniture(MapData& map, double share, Rng& rng) {
  move_furniture(map, share, 0.0, rng);
}

void shift_furniture(MapData& map, double share, Rng& rng) {
  constexpr double farthest = 2.0;  // m
  move_furniture(map, share, farthest, rng);
}

/// A share of the furniture was mapped at the height of its legs: what is farther than 0.1 m, along either
/// axis, from all corners of its extent is free.
void leave_legs(MapData& map, double share, Rng& rng) {
  constexpr double leg = 0.1;  // m
  OccupancyGrid& grid = map.grid;
  const int cells = std::max(1, static_cast<int>(std::lround(leg / grid.resolution)));
  for (const std::vector<CellAt>& component : some_furniture(grid, share, rng)) {
    const auto [least, most] = ends_of(component);
    for (const CellAt at : component) {
      const bool is_leg = std::min(at.column - least.column, most.column - at.column) < cells &&
                          std::min(at.row - least.row, most.row - at.row) < cells;
      if (!is_leg) grid.cell(at.column, at.row) = Cell::free;
    }
  }
  take_points_of_cells(map);
}

/// Boxes of 0.3 to 1.2 m that the world does not have, so many on 100 square metres of free cells.
void bring_boxes(MapData& map, double density, Rng& rng) {
  OccupancyGrid& grid = map.grid;
  std::vector<CellAt> free;
  for_each_cell(grid, [&](int column, int row) {
    if (grid.cell(column, row) == Cell::free) free.push_back({column, row});
  });
  if (free.empty()) return;
  const double area = static_cast<double>(free.size()) * grid.resolution * grid.resolution;
  const auto boxes = std::lround(density * area / 100.0);
  const auto side = [&] { return static_cast<int>(std::lround(rng.uniform(0.3, 1.2) / grid.resolution)); };
  for (long i = 0; i < boxes; ++i) {
    const CellAt corner = free[rng.below(static_cast<std::uint32_t>(free.size()))];
    const int right = std::min(corner.column + side(), grid.width);
    const int top = std::min(corner.row + side(), grid.height);
    for (int row = corner.row; row < top; ++row) {
      for (int column = corner.column; column < right; ++column) {
        if (grid.cell(column, row) == Cell::free) grid.cell(column, row) = Cell::occupied;
      }
    }
  }
  take_points_of_cells(map);
}

std::uint64_t block_of(double coordinate) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(coordinate / block)));
}

/// Keeps those points, and what is occupied of the cells, that `is_kept` says.
template <class IsKept>
void keep_if(MapData& map, Cell instead, IsKept is_kept) {
  Points points, normals;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    if (!is_kept(map.points.x[i], map.points.y[i])) continue;
    points.push_back(map.points[i]);
    if (!map.normals.empty()) normals.push_back(map.normals[i]);
  }
  map.points = std::move(points);
  map.normals = std::move(normals);
  for_each_cell(map.grid, [&](int column, int row) {
    const Pose2 centre = map.grid.centre(column, row);
    PackedCells::Reference cell = map.grid.cell(column, row);
    const bool is_changed = instead == Cell::unknown ? cell != Cell::unknown : cell == Cell::occupied;
    if (is_changed && !is_kept(centre.x, centre.y)) cell = instead;
  });
}

void drop_walls(MapData& map, double share, Rng& rng) {
  const Rng of_map(rng.next());
  keep_if(map, Cell::free, [&](double x, double y) {
    return of_map.stream({block_of(x), block_of(y)}).uniform() >= share;
  });
}

/// What lies in the last share of the map's length along x was never mapped.
void cut_off(MapData& map, double share, Rng& /*rng*/) {
  const Extent along_x = extent_of(map.points.x);
  const double end = along_x.high - share * along_x.length();
  keep_if(map, Cell::unknown, [&](double x, double /*y*/) { return x <= end; });
}

/// What was occupied is free, but for the cells that points lie in now. Points in space do not make cells.
void take_cells_of_points(MapData& map) {
  OccupancyGrid& grid = map.grid;
  if (grid.cells.empty() || has_heights(map)) return;
  std::replace(grid.cells.begin(), grid.cells.end(), Cell::occupied, Cell::free);
  const Pose2 grid_from_map = inverse(grid.map_from_grid);
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Pose2 at = grid_from_map * Pose2{map.points.x[i], map.points.y[i], 0.0};
    const auto column = static_cast<int>(std::floor(at.x / grid.resolution));
    const auto row = static_cast<int>(std::floor(at.y / grid.resolution));
    if (grid.holds(column, row)) grid.cell(column, row) = Cell::occupied;
  }
}

/// Each point is measured with a normal error of `sigma` metres; cells follow their points.
void blur(MapData& map, double sigma, Rng& rng) {
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    map.points.x[i] += static_cast<float>(rng.normal(sigma));
    map.points.y[i] += static_cast<float>(rng.normal(sigma));
  }
  take_cells_of_points(map);
}

/// Cells of `factor` times the side: occupied if one of those within is, unknown if all are.
void coarsen(MapData& map, double factor, Rng& /*rng*/) {
  const OccupancyGrid& fine = map.grid;
  const auto n = static_cast<int>(std::lround(factor));
  OccupancyGrid coarse{.map_from_grid = fine.map_from_grid,
                       .resolution = n * fine.resolution,
                       .width = (fine.width + n - 1) / n,
                       .height = (fine.height + n - 1) / n,
                       .cells = {}};
  coarse.cells =
      PackedCells(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height));
  for_each_cell(fine, [&](int column, int row) {
    PackedCells::Reference cell = coarse.cell(column / n, row / n);
    cell = std::max<Cell>(cell, fine.cell(column, row));
  });
  map.grid = std::move(coarse);
  take_points_of_cells(map);
}

/// What lies north of the middle of the points is moved east, by so many parts of a thousand of how far north
/// it lies; cells follow their points.
void shear(MapData& map, double per_mille, Rng& /*rng*/) {
  const double y = extent_of(map.points.y).middle();
  for (std::size_t i = 0; i < map.points.size(); ++i)
    map.points.x[i] += static_cast<float>(per_mille / 1000.0 * (map.points.y[i] - y));
  take_cells_of_points(map);
}

/// The map is longer than the world, by so many parts of a thousand, about the middle of its points.
void stretch_map(MapData& map, double per_mille, Rng& /*rng*/) {
  const double factor = 1.0 + per_mille / 1000.0;
  const double x = extent_of(map.points.x).middle(), y = extent_of(map.points.y).middle();
  for (float& px : map.points.x) px = static_cast<float>(x + factor * (px - x));
  for (float& py : map.points.y) py = static_cast<float>(y + factor * (py - y));
  map.grid.map_from_grid.x = x + factor * (map.grid.map_from_grid.x - x);
  map.grid.map_from_grid.y = y + factor * (map.grid.map_from_grid.y - y);
  map.grid.resolution *= factor;
}

constexpr std::array map_kinds = {
    MapDisturbanceKind{{"taken",
                        "share of the furniture that the map has lost",
                        "",
                        1.0,
                        {0.1, 0.25, 0.5, 0.75, 1.0},
                        "plans have none: level 5"},
                       Changes::cells,
                       take_furniture},
    MapDisturbanceKind{{"moved",
                        "share of the furniture that stands up to 2 m from where it is",
                        "",
                        1.0,
                        {0.1, 0.25, 0.5, 0.75, 1.0},
                        "a day, a week, a year of use"},
                       Changes::cells,
                       shift_furniture},
    MapDisturbanceKind{{"other_height",
                        "share of the furniture that was mapped at the height of its legs",
                        "",
                        1.0,
                        {0.1, 0.25, 0.5, 0.75, 1.0},
                        "tables are four legs to one sensor and a top to another"},
                       Changes::cells,
                       leave_legs},
    MapDisturbanceKind{{"brought",
                        "boxes that are gone since the map was made, on 100 square metres free",
                        "",
                        1000.0,
                        {1.0, 2.0, 4.0, 8.0, 16.0},
                        "16 boxes of half a square metre fill a twelfth of the floor"},
                       Changes::cells,
                       bring_boxes},
    MapDisturbanceKind{{"missing_walls",
                        "share of walls that the map lacks, by blocks of 1 m",
                        "",
                        0.99,
                        {0.05, 0.1, 0.2, 0.35, 0.5},
                        "glass, doors, and what was never seen"},
                       Changes::points,
                       drop_walls},
    MapDisturbanceKind{{"cut_off",
                        "share of the map's length along x that was never mapped",
                        "",
                        0.99,
                        {0.1, 0.2, 0.3, 0.4, 0.5},
                        "robots begin where nobody has mapped, too"},
                       Changes::places,
                       cut_off},
    MapDisturbanceKind{{"blurred",
                        "standard deviation of a point of the map",
                        "m",
                        10.0,
                        {0.02, 0.04, 0.06, 0.09, 0.12},
                        "as the noise of a sensor"},
                       Changes::points,
                       blur},
    MapDisturbanceKind{{"coarse",
                        "by which cells are larger",
                        "",
                        100.0,
                        {2.0, 3.0, 4.0, 6.0, 8.0},
                        "cells of 5 cm become 10 to 40 cm",
                        2},
                       Changes::cells,
                       coarsen},
    MapDisturbanceKind{{"stretched",
                        "by which the map is too long",
                        "per mille",
                        500.0,
                        {1.0, 2.0, 3.0, 5.0, 10.0},
                        "odometry of a mapping robot; reference poses are in the true map, so the ends of "
                        "long maps cannot be right at level 5"},
                       Changes::places,
                       stretch_map},
    MapDisturbanceKind{{"sheared",
                        "by which north leans to the east",
                        "per mille",
                        500.0,
                        {1.0, 2.0, 3.0, 5.0, 10.0},
                        "scanned plans, and loops that closed badly"},
                       Changes::places,
                       shear},
};

}  // namespace

bool has_heights(const MapData& map) {
  return std::ranges::any_of(map.points.z, [](float z) { return z != 0.0F; });
}

std::span<const MapDisturbanceKind> map_disturbance_kinds() {
  return map_kinds;
}

}  // namespace glocal::disturbed
