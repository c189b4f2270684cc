#include "sources/ros_map_writer.hpp"

#include <fmt/format.h>

namespace glocal {
namespace {

char grey_of(Cell cell) {
  switch (cell) {
    case Cell::occupied:
      return '\0';
    case Cell::free:
      return static_cast<char>(254);
    case Cell::unknown:
      break;
  }
  return static_cast<char>(205);
}

}  // namespace

ByteImage trinary_image(const OccupancyGrid& grid) {
  ByteImage image{grid.width, grid.height, {}};
  image.grey.reserve(grid.cells.size());
  for (int row = grid.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width; ++column) image.grey += grey_of(grid.cell(column, row));
  }
  return image;
}

std::string ros_map_yaml(const OccupancyGrid& grid, const std::string& image_name) {
  const Pose2& origin = grid.map_from_grid;
  return fmt::format(
      "image: \"{}\"\n"
      "mode: trinary\n"
      "resolution: {}\n"
      "origin: [{}, {}, {}]\n"
      "negate: 0\n"
      "occupied_thresh: 0.65\n"
      "free_thresh: 0.196\n",
      image_name, grid.resolution, origin.x, origin.y, origin.theta);
}

}  // namespace glocal
