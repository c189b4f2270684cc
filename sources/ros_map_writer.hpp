// Maps written for the ROS map server.
#pragma once

#include <string>

#include "glocal/occupancy_grid.hpp"
#include "sources/image.hpp"

namespace glocal {

/// Occupied black, free white, unknown grey (205), as map savers write it.
[[nodiscard]] ByteImage trinary_image(const OccupancyGrid& grid);

/// The YAML file that goes with trinary_image() of a grid. Numbers are exact.
[[nodiscard]] std::string ros_map_yaml(const OccupancyGrid& grid, const std::string& image_name);

}  // namespace glocal
