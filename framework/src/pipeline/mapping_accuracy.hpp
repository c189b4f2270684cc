// How far a local mapper drifts, measured on a drive with reference poses.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "glocal/observation.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

/// Where a mapper starts afresh, and when its pose is compared. Distances are metres along the reference
/// path.
struct MappingWindows {
  double every_m = 5.0;           ///< From one start to the next.
  double after_m = 10.0;          ///< Driven when the error is taken.
  double fail_after_m = 30.0;     ///< Driven when it is judged whether the map has failed …
  double fail_translation = 0.5;  ///< … by an error over this (m) …
  double fail_rotation = 0.0873;  ///< … or this (rad).
  double cell = 0.05;             ///< Side of the cells that hits are counted in, m.
};

/// One start of a mapper. Errors are infinite where the mapper had started a new map on the way.
struct MappingWindow {
  std::size_t first = 0;             ///< Observation the mapper started at.
  double translation_error_m = 0.0;  ///< After `after_m`.
  double rotation_error_rad = 0.0;
  std::size_t occupied_cells =
      0;                       ///< Cells that hits fell in, placed by the mapper's poses: fewer is sharper.
  std::optional<bool> failed;  ///< None if the drive is interrupted before `fail_after_m`.
};

struct MappingAccuracy {
  std::vector<MappingWindow> windows;
  std::vector<double> add_ms;  ///< Wall-clock time of each LocalMapper::add.
};

/// Starts `mapper` every `every_m` of the drive and compares the way it says the robot has gone with the
/// reference. A start counts if the drive goes on for `after_m` without interruption (a change of
/// Sample::segment). Throws ConfigError if an observation has no reference pose.
[[nodiscard]] MappingAccuracy measure_mapping(const std::vector<Sample>& drive, LocalMapper& mapper,
                                              const MappingWindows& windows);

/// The value below which `share` (in [0, 1]) of the values lie, interpolated between neighbours; none without
/// values.
[[nodiscard]] std::optional<double> quantile(std::vector<double> values, double share);

}  // namespace glocal
