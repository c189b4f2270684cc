#include "matchers/grid_search/contact_pyramid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "glocal/error.hpp"

namespace glocal {

void check_cell(double cell, double epsilon) {
  if (cell <= epsilon) return;
  throw ConfigError(
      {{"", 0, 0,
        fmt::format("the cell of {} m of an exact search is larger than contact_epsilon, which is "
                    "{:.3g} m on this map; take a smaller cell or a larger contact_epsilon",
                    cell, epsilon)}});
}

CellFrame cell_frame(const Points& map_points, double cell, double epsilon, Motion motion) {
  const auto least = [&](const std::vector<float>& values) {
    return *std::min_element(values.begin(), values.end()) - epsilon;
  };
  const auto cells = [&](const std::vector<float>& values) {
    const double most = *std::max_element(values.begin(), values.end()) + epsilon;
    return std::floor((most - least(values)) / cell) + 1.0;
  };
  const bool in_space = motion != Motion::planar;
  const double columns = cells(map_points.x);
  const double rows = cells(map_points.y);
  const double layers = in_space ? cells(map_points.z) : 1.0;
  constexpr double largest = 1024.0 * 1024.0 * 1024.0;
  if (!(columns * rows * layers <= largest)) {
    throw ConfigError({{"", 0, 0,
                        fmt::format("the map is too large for a grid of cells of {} m: it would need more "
                                    "than 1 GiB; cut the map, or take a larger cell",
                                    cell)}});
  }
  return {.cell = cell,
          .min_x = least(map_points.x),
          .min_y = least(map_points.y),
          .min_z = in_space ? least(map_points.z) : 0.0,
          .columns = static_cast<int>(columns),
          .rows = static_cast<int>(rows),
          .layers = static_cast<int>(layers),
          .in_space = in_space};
}

namespace {

/// Four windows make one of twice the side, or eight in space; those read have not been replaced yet.
void join(Windows& windows, std::size_t half) {
  std::vector<std::uint8_t>& bytes = windows.bytes;
  const std::size_t layer = windows.width * windows.height;
  for (std::size_t row = 0; row < windows.height * windows.depth; ++row) {
    for (std::size_t i = row * windows.width; i + half < (row + 1) * windows.width; ++i)
      bytes[i] |= bytes[i + half];
  }
  for (std::size_t z = 0; z < windows.depth; ++z) {
    for (std::size_t i = z * layer; i + half * windows.width < (z + 1) * layer; ++i)
      bytes[i] |= bytes[i + half * windows.width];
  }
  for (std::size_t i = 0; i + half * layer < bytes.size(); ++i) bytes[i] |= bytes[i + half * layer];
}

/// Marks cells in the layers that the windows have.
void mark_near(Windows& windows, const Points& map_points, const CellFrame& frame, double epsilon,
               bool anywhere) {
  const double half_cell = anywhere ? 0.5 : 0.0;
  const double reach = epsilon / frame.cell;
  const auto first = [&](double centre, int least) {
    return std::max(least, static_cast<int>(std::ceil(centre - reach - half_cell)));
  };
  const auto square = [&](double distance) {
    const double beyond = std::max(0.0, std::abs(distance) - half_cell);
    return beyond * beyond;
  };
  const int first_layer = std::max(0, -windows.layers_before);
  const int layers = std::min(frame.layers, static_cast<int>(windows.depth) - windows.layers_before);
  for (std::size_t i = 0; i < map_points.size(); ++i) {
    // In cells, relative to the centre of cell (0, 0, 0).
    const double x = (map_points.x[i] - frame.min_x) / frame.cell - 0.5;
    const double y = (map_points.y[i] - frame.min_y) / frame.cell - 0.5;
    const double z = frame.in_space ? (map_points.z[i] - frame.min_z) / frame.cell - 0.5 : 0.0;
    for (int l = first(z, first_layer); l < layers && l <= z + reach + half_cell; ++l) {
      for (int r = first(y, 0); r < frame.rows && r <= y + reach + half_cell; ++r) {
        for (int c = first(x, 0); c < frame.columns && c <= x + reach + half_cell; ++c) {
          if (square(c - x) + square(r - y) + square(l - z) <= reach * reach) windows.at(c, r, l) = 1;
        }
      }
    }
  }
}

}  // namespace

Windows cells_near(const Points& map_points, const CellFrame& frame, double epsilon, bool anywhere,
                   int before) {
  const int layers_before = frame.in_space ? before : 0;
  Windows windows{.columns_before = before,
                  .rows_before = before,
                  .layers_before = layers_before,
                  .width = static_cast<std::size_t>(frame.columns + before),
                  .height = static_cast<std::size_t>(frame.rows + before),
                  .depth = static_cast<std::size_t>(frame.layers + layers_before),
                  .in_space = frame.in_space};
  mark_near(windows, map_points, frame, epsilon, anywhere);
  return windows;
}

Windows layer_near(const Points& map_points, const CellFrame& frame, double epsilon, bool anywhere,
                   int layer) {
  Windows windows{.layers_before = -layer,
                  .width = static_cast<std::size_t>(frame.columns),
                  .height = static_cast<std::size_t>(frame.rows),
                  .in_space = frame.in_space};
  mark_near(windows, map_points, frame, epsilon, anywhere);
  windows.layers_before = 0;
  return windows;
}

ContactPyramid::ContactPyramid(const Points& map_points, double cell, double epsilon, int top_level,
                               Motion motion)
    : frame_(cell_frame(map_points, cell, epsilon, motion)) {
  Windows windows = cells_near(map_points, frame_, epsilon, false, (1 << top_level) - 1);
  for (int level = 0; level <= top_level; ++level) {
    if (level > 0) join(windows, std::size_t{1} << (level - 1));
    levels_.emplace_back(level, windows);
  }
}

std::size_t ContactPyramid::memory_bytes() const {
  std::size_t bytes = 0;
  for (const WindowBits& level : levels_) bytes += level.memory_bytes();
  return bytes;
}

std::size_t ContactPyramid::count(int level, const CellPoints& points, int column, int row, std::size_t least,
                                  TileCounts& counts, int layer) const {
  counts.clear();
  return levels_[static_cast<std::size_t>(level)].add(points, column, row, layer, least, 0, counts);
}

std::shared_ptr<const ContactPyramid> contact_pyramid(const GlobalMap& map, double cell, double epsilon,
                                                      Motion motion) {
  check_cell(cell, epsilon);
  const bool in_space = motion != Motion::planar;
  return map.index<ContactPyramid>(fmt::format("{} {}{}", cell, epsilon, in_space ? " in space" : ""), [&] {
    return ContactPyramid(map.points(), cell, epsilon, ContactPyramid::default_top_level, motion);
  });
}

}  // namespace glocal
