#include "sources/world_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

namespace glocal {
namespace {

constexpr double fine_resolution = 0.05;  // m
constexpr double most_cells = 4e6;        // of reality, by which nothing is measured

/// A grid whose cells are centred on multiples of its resolution.
class Raster {
 public:
  Raster(const World& world, double resolution) {
    grid_.map_from_grid = {-resolution / 2.0, -resolution / 2.0, 0.0};
    grid_.resolution = resolution;
    grid_.width = nearest(world.size[0]) + 1;
    grid_.height = nearest(world.size[1]) + 1;
    grid_.cells.resize(static_cast<std::size_t>(grid_.width) * static_cast<std::size_t>(grid_.height));
  }

  /// Without gaps, and one cell thick: one cell for each column of a flat line, or row of a steep one.
  void draw(const Segment& s) {
    const int steps = std::max(std::abs(nearest(s.to[0]) - nearest(s.from[0])),
                               std::abs(nearest(s.to[1]) - nearest(s.from[1])));
    for (int i = 0; i <= steps; ++i) {
      const double share = steps == 0 ? 0.0 : static_cast<double>(i) / steps;
      mark(s.from[0] + share * (s.to[0] - s.from[0]), s.from[1] + share * (s.to[1] - s.from[1]));
    }
  }

  void draw(const Circle& c) {
    const int steps =
        static_cast<int>(std::ceil(2.0 * std::numbers::pi * c.radius / (0.5 * grid_.resolution)));
    for (int i = 0; i < steps; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / steps;
      mark(c.centre[0] + c.radius * std::cos(angle), c.centre[1] + c.radius * std::sin(angle));
    }
  }

  /// Frees everything that can be reached from a place without crossing an outline.
  void flood(const Position& from) {
    std::vector<std::array<int, 2>> open{{nearest(from[0]), nearest(from[1])}};
    while (!open.empty()) {
      const auto [column, row] = open.back();
      open.pop_back();
      if (!holds(column, row) || grid_.cell(column, row) != Cell::unknown) continue;
      grid_.cell(column, row) = Cell::free;
      for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
        open.push_back({column + dx, row + dy});
    }
  }

  void forget(const UnmappedArea& area) {
    const auto [left, right] = std::minmax(area.corners[0][0], area.corners[1][0]);
    const auto [low, high] = std::minmax(area.corners[0][1], area.corners[1][1]);
    for (int row = std::max(nearest(low), 0); row <= std::min(nearest(high), grid_.height - 1); ++row) {
      for (int column = std::max(nearest(left), 0); column <= std::min(nearest(right), grid_.width - 1);
           ++column) {
        grid_.cell(column, row) = Cell::unknown;
      }
    }
  }

  [[nodiscard]] OccupancyGrid take() { return std::move(grid_); }

 private:
  [[nodiscard]] int nearest(double metres) const {
    return static_cast<int>(std::floor(metres / grid_.resolution + 0.5));
  }
  [[nodiscard]] bool holds(int column, int row) const {
    return column >= 0 && column < grid_.width && row >= 0 && row < grid_.height;
  }
  void mark(double x, double y) {
    if (holds(nearest(x), nearest(y))) grid_.cell(nearest(x), nearest(y)) = Cell::occupied;
  }

  OccupancyGrid grid_;
};

Raster drawn(const World& world, const Shapes& shapes, double resolution) {
  Raster raster(world, resolution);
  for (const Segment& segment : shapes.segments) raster.draw(segment);
  for (const Circle& circle : shapes.circles) raster.draw(circle);
  return raster;
}

}  // namespace

OccupancyGrid plan_of(const World& world, double resolution) {
  Raster raster = drawn(world, shapes_on_map(world), resolution);
  for (const Position& place : world.free_from) raster.flood(place);
  for (const UnmappedArea& area : world.unmapped) raster.forget(area);
  return raster.take();
}

OccupancyGrid reality_of(const World& world) {
  const double coarse_resolution = std::sqrt(world.size[0] * world.size[1] / most_cells);
  Raster raster = drawn(world, shapes_in_reality(world), std::max(fine_resolution, coarse_resolution));
  raster.flood(world.way_points.front());
  return raster.take();
}

}  // namespace glocal
