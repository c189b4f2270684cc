#include "sources/simulation/added_things.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "glocal/error.hpp"
#include "sources/grid_ray.hpp"
#include "sources/simulation/clear_cells.hpp"

namespace glocal::simulation {
namespace {

/// Draws for a box; where so many find no room there is hardly any.
constexpr int most_draws = 1000;

/// Marks the cells that a way of straight parts leads through.
void mark_cells_of(const std::vector<Position>& way, const OccupancyGrid& grid, std::vector<char>& marks) {
  const auto mark = [&](int column, int row) {
    if (grid.holds(column, row)) marks[grid.index(column, row)] = 1;
    return grid.holds(column, row);
  };
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Position end = on_grid(way[i], grid);
    const Position start = on_grid(way[i == 0 ? 0 : i - 1], grid);
    visit_cells_before_end(start[0], start[1], end[0], end[1],
                           [&](int column, int row, double) { return mark(column, row); });
    mark(static_cast<int>(std::floor(end[0])), static_cast<int>(std::floor(end[1])));
  }
}

/// Cells on which nothing may be put: what is not free, or too near to a way.
std::vector<char> taken_cells(const OccupancyGrid& grid, const std::vector<std::vector<Position>>& ways,
                              double clearance) {
  std::vector<char> is_way(grid.cells.size(), 0);
  for (const std::vector<Position>& way : ways) mark_cells_of(way, grid, is_way);
  std::vector<char> is_taken = grown(is_way, clearance, grid);
  for (std::size_t i = 0; i < is_taken.size(); ++i) {
    if (grid.cells[i] != Cell::free || is_way[i] != 0) is_taken[i] = 1;
  }
  return is_taken;
}

/// Indexes of the cells that a box may touch; of a box that sticks out of the grid, none.
std::vector<std::size_t> cells_under(const Rectangle& box, const OccupancyGrid& grid) {
  const Pose2 map_from_box{box.centre[0], box.centre[1], radians(box.angle_deg)};
  const Pose2 box_from_grid = inverse(map_from_box) * grid.map_from_grid;
  const Pose2 centre = inverse(box_from_grid);
  const double reach = 0.5 * std::hypot(box.size[0], box.size[1]) + grid.resolution;
  const int left = static_cast<int>(std::floor((centre.x - reach) / grid.resolution));
  const int right = static_cast<int>(std::floor((centre.x + reach) / grid.resolution));
  const int low = static_cast<int>(std::floor((centre.y - reach) / grid.resolution));
  const int high = static_cast<int>(std::floor((centre.y + reach) / grid.resolution));
  if (left < 0 || low < 0 || right >= grid.width || high >= grid.height) return {};
  const double half_diagonal = grid.resolution / std::numbers::sqrt2;
  std::vector<std::size_t> cells;
  for (int row = low; row <= high; ++row) {
    for (int column = left; column <= right; ++column) {
      const Pose2 cell =
          box_from_grid * Pose2{(column + 0.5) * grid.resolution, (row + 0.5) * grid.resolution, 0.0};
      const bool is_near = std::abs(cell.x) <= box.size[0] / 2.0 + half_diagonal &&
                           std::abs(cell.y) <= box.size[1] / 2.0 + half_diagonal;
      if (is_near) cells.push_back(grid.index(column, row));
    }
  }
  return cells;
}

Rectangle drawn_box(const ClearRegion& region, Rng& rng) {
  const Position centre = region.draw(rng);
  return {.centre = {centre[0], centre[1]},
          .size = {rng.uniform(0.3, 1.0), rng.uniform(0.3, 1.0)},
          .angle_deg = rng.uniform(0.0, 180.0),
          .height = rng.uniform(0.5, 1.5),
          .presence = {.on_map = false}};
}

}  // namespace

std::vector<Walker> drawn_people(int count, const ClearRegion& region, Rng rng) {
  std::vector<Walker> people;
  for (int i = 0; i < count; ++i) {
    const Position from = region.draw(rng);
    std::vector<Position> way = region.way(from, region.draw(rng));
    way.insert(way.begin(), from);
    people.push_back({.points = std::move(way), .speed = rng.uniform(0.4, 1.2)});
  }
  return people;
}

std::vector<Rectangle> drawn_boxes(int count, const OccupancyGrid& grid, const ClearRegion& region,
                                   const std::vector<std::vector<Position>>& ways, double clearance, Rng rng,
                                   const std::string& file) {
  if (count == 0) return {};
  std::vector<char> is_taken = taken_cells(grid, ways, clearance);
  std::vector<Rectangle> boxes;
  for (int draws = 0; boxes.size() < static_cast<std::size_t>(count); ++draws) {
    if (draws == most_draws) {
      throw ConfigError(file,
                        fmt::format("boxes: room was found for {} of {} boxes on free space off the ways of "
                                    "robot and people; lower boxes, people or clearance",
                                    boxes.size(), count));
    }
    const Rectangle box = drawn_box(region, rng);
    const std::vector<std::size_t> cells = cells_under(box, grid);
    const bool has_room =
        !cells.empty() && std::ranges::all_of(cells, [&](std::size_t i) { return is_taken[i] == 0; });
    if (!has_room) continue;
    for (const std::size_t i : cells) is_taken[i] = 1;
    boxes.push_back(box);
    draws = -1;
  }
  return boxes;
}

}  // namespace glocal::simulation
