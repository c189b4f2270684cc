// How far a local mapper drifts, measured on a drive with reference poses.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evaluation/running/drive.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

/// Where a mapper starts afresh, and when its pose is compared. Distances are metres along Drive::path_m.
struct MappingWindows {
  bool whole = false;          ///< One start, and the error is taken where the drive ends or is interrupted.
  double every_m = 5.0;        ///< From one start to the next.
  double after_m = 10.0;       ///< Driven when the error is taken.
  double fail_after_m = 30.0;  ///< Driven when it is judged whether the map has failed …
  double fail_translation = 0.5;   ///< … by an error over this (m) …
  double fail_rotation_deg = 5.0;  ///< … or this.
  double cell = 0.05;              ///< Side of the cells that hits are counted in, m.
};

/// One start of a mapper. Where it has started a new map on the way it knows nothing of the way before: the
/// error is then all of the way driven, and half a turn.
struct MappingWindow {
  std::size_t first = 0;  ///< Sample the mapper started at.
  PoseError error;        ///< After `after_m`, or at the end.
  std::size_t occupied_cells =
      0;  ///< Cells hits fell in up to there, placed by the mapper's poses: fewer is sharper.
  std::optional<bool> failed;  ///< None if the drive is interrupted before `fail_after_m`.
};

struct MappingAccuracy {
  std::vector<MappingWindow> windows;
  std::vector<double> add_ms;  ///< Wall-clock time of each LocalMapper::add.
};

/// Starts `mapper` every `every_m` of the drive and compares the way it says the robot has gone with the
/// reference. A start counts if the drive goes on for `after_m` without interruption (a change of
/// Sample::segment). Throws ConfigError if a sample has no reference pose.
[[nodiscard]] MappingAccuracy measure_mapping(const Drive& drive, LocalMapper& mapper,
                                              const MappingWindows& windows);

}  // namespace glocal
