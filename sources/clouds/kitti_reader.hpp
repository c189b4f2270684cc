// Clouds as the KITTI data set has them (velodyne, *.bin): x y z intensity, float32 little-endian.
#pragma once

#include <string>
#include <string_view>

#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// Throws ConfigError, with the number of the point, if this is no such cloud.
[[nodiscard]] Cloud read_kitti_cloud(std::string_view content, const std::string& file,
                                     const CloudOptions& options);

}  // namespace glocal::clouds
