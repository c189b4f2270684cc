// CARMEN logs, written.
#pragma once

#include <string>

#include "sources/carmen/carmen_parser.hpp"

namespace glocal::carmen {

/// A scan as a ROBOTLASER1 line, which says where each reading looks, after a TRUEPOS line if its reference
/// pose is known. Readings are written to the millimetre, poses to the micrometre and microradian.
[[nodiscard]] std::string carmen_lines(const CarmenScan& scan);

}  // namespace glocal::carmen
