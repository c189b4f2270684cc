// Points as PCD files, for viewers and for glocal report.
#pragma once

#include <filesystem>
#include <string>

#include "glocal/global_map.hpp"
#include "glocal/points.hpp"

namespace glocal {

/// Points as a binary PCD file (version 0.7, fields x y z): in single precision, or where they are relative
/// to an origin, in double precision, with it.
[[nodiscard]] std::string pcd(const Points& points, const Vector3& origin = Vector3::Zero());

/// Points of a map, relative to an origin.
struct MapPoints {
  Points points;
  Vector3 origin = Vector3::Zero();  ///< m, in the map's frame.
};

/// Points of a file as pcd() makes it. Throws ConfigError for any other PCD file, and for one that is not
/// whole or has coordinates that are no numbers, beyond `farthest_m`, or over 2000 km from the origin.
[[nodiscard]] MapPoints read_map_pcd(const std::filesystem::path& file);

/// The points alone: of local maps and scans, which have no origin.
[[nodiscard]] Points read_pcd(const std::filesystem::path& file);

}  // namespace glocal
