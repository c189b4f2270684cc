// Clouds of points from files of any format that is known.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// The cloud in a file: PCD, PLY or OctoMap's binary tree, known by what the file begins with, or KITTI's,
/// known by its name (*.bin); perhaps compressed (gzip, bzip2, xz). Throws ConfigError with what is wrong,
/// and where.
[[nodiscard]] Cloud read_cloud(const std::filesystem::path& file, const CloudOptions& options = {});

/// Whether a file of this name might be a cloud that a sensor has measured: no octree, which is a map.
[[nodiscard]] bool has_name_of_cloud(const std::filesystem::path& file);

/// Standard deviations along the principal axes, m, falling. A single point has none.
[[nodiscard]] std::array<double, 3> principal_spreads(const Points& points);

/// What its reader should be told of a cloud, a sentence each: points left out, a size that speaks for
/// another unit, places that single precision rounds, points that all lie in a plane or on a line.
[[nodiscard]] std::vector<std::string> cloud_remarks(const Cloud& cloud);

}  // namespace glocal::clouds
