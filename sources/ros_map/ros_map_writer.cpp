#include "sources/ros_map/ros_map_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "glocal/yaml.hpp"

namespace glocal::ros_map {
namespace {

/// Of cells that are unknown, free and occupied, as Cell has them in order.
constexpr std::array<unsigned char, 3> greys = {205, 254, 0};

/// The rows of a grid from the highest down.
void append_rows(const OccupancyGrid& grid, int from, int count, std::string& grey) {
  for (int row = from; row > from - count; --row) {
    for (int column = 0; column < grid.width; ++column)
      grey += static_cast<char>(greys[static_cast<std::size_t>(grid.cell(column, row))]);
  }
}

}  // namespace

ByteImage trinary_image(const OccupancyGrid& grid) {
  ByteImage image{grid.width, grid.height, {}};
  image.grey.reserve(grid.cells.size());
  append_rows(grid, grid.height - 1, grid.height, image.grey);
  return image;
}

void write_trinary_pgm(const OccupancyGrid& grid, const std::function<void(std::string_view)>& write) {
  constexpr int rows_a_piece = 256;
  write(pgm({grid.width, grid.height, {}}));
  for (int row = grid.height - 1; row >= 0; row -= rows_a_piece) {
    std::string grey;
    append_rows(grid, row, std::min(rows_a_piece, row + 1), grey);
    write(grey);
  }
}

std::string ros_map_yaml(const OccupancyGrid& grid, const std::string& image_name, const Vector3& origin) {
  const Pose2& corner = grid.map_from_grid;
  return fmt::format(
      "image: {}\n"
      "mode: trinary\n"
      "resolution: {}\n"
      "origin: [{}, {}, {}]\n"
      "negate: 0\n"
      "occupied_thresh: 0.65\n"
      "free_thresh: 0.196\n",
      to_yaml(image_name), grid.resolution, origin.x() + corner.x, origin.y() + corner.y, corner.theta);
}

}  // namespace glocal::ros_map
