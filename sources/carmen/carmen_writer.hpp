// CARMEN logs, written.
#pragma once

#include <string>

#include "sources/carmen/carmen_parser.hpp"

namespace glocal::carmen {

/// A scan as a ROBOTLASER1 line, which says where each reading looks, after a TRUEPOS line if its reference
/// pose is known. Readings and poses read back as they are, stamps are written to the microsecond.
[[nodiscard]] std::string carmen_lines(const CarmenScan& scan);

}  // namespace glocal::carmen
