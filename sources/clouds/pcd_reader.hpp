// Clouds as PCD files (Point Cloud Library), versions .5 to .7.
#pragma once

#include <string>
#include <string_view>

#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// Whether a file that begins so is a PCD file.
[[nodiscard]] bool is_pcd(std::string_view content);

/// DATA ascii, binary and binary_compressed; any fields besides x, y and z, each of any type. Throws
/// ConfigError, with the line or the number of the point, if this is no such cloud, if the header announces
/// something else than is there, or if the points have more than the options allow when decompressed.
[[nodiscard]] Cloud read_pcd_cloud(std::string_view content, const std::string& file,
                                   const CloudOptions& options);

}  // namespace glocal::clouds
