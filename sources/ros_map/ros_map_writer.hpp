// Maps written for the ROS map server.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "glocal/occupancy_grid.hpp"
#include "glocal/pose3.hpp"
#include "sources/ros_map/image.hpp"

namespace glocal::ros_map {

/// Occupied black, free white, unknown grey (205), as map savers write it.
[[nodiscard]] ByteImage trinary_image(const OccupancyGrid& grid);

/// The same image as a binary PGM file, handed over piece by piece: large maps need not be in memory twice.
void write_trinary_pgm(const OccupancyGrid& grid, const std::function<void(std::string_view)>& write);

/// The YAML file that goes with trinary_image() of a grid, which is relative to a map's origin. Numbers are
/// exact.
[[nodiscard]] std::string ros_map_yaml(const OccupancyGrid& grid, const std::string& image_name,
                                       const Vector3& origin = Vector3::Zero());

}  // namespace glocal::ros_map
