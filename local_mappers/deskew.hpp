// Scans that were made in motion, as if they were of one moment.
#pragma once

#include <optional>

#include "glocal/observation.hpp"

namespace glocal::local_mappers {

/// How a robot moves: by `last_from_now` in so many seconds, straight and turning evenly.
struct SteadyMotion {
  Pose3 last_from_now;
  double seconds = 0.0;
};

/// The scan with its hits in the robot's frame at the observation's stamp, without times. None where the scan
/// has no times; or where one of them is farther from the stamp than twice `seconds`, as stamps that stand
/// still have it.
[[nodiscard]] std::optional<Scan> deskewed(const Scan& scan, const SteadyMotion& motion);

}  // namespace glocal::local_mappers
