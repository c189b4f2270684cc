// Clouds as PLY files (Stanford), version 1.0: the vertices, whatever else there is.
#pragma once

#include <string>
#include <string_view>

#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// Whether a file that begins so is a PLY file.
[[nodiscard]] bool is_ply(std::string_view content);

/// Text and binary of both byte orders. Throws ConfigError, with the line or the number of the point, if this
/// is no such cloud or ends before its last vertex.
[[nodiscard]] Cloud read_ply_cloud(std::string_view content, const std::string& file,
                                   const CloudOptions& options);

}  // namespace glocal::clouds
