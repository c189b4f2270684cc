// Points as PCD files, for viewers and for glocal report.
#pragma once

#include <filesystem>
#include <string>

#include "glocal/points.hpp"

namespace glocal {

/// Points as a binary PCD file (version 0.7, fields x y z).
[[nodiscard]] std::string pcd(const Points& points);

/// Points of a file as pcd() makes it. Throws ConfigError for any other PCD file, and for one that is not
/// whole or has coordinates that are no numbers or over 2000 km.
[[nodiscard]] Points read_pcd(const std::filesystem::path& file);

}  // namespace glocal
