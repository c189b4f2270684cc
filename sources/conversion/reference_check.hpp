// What is wrong with reference poses, as odometry and hand-made measurements show it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "sources/conversion/drive_track.hpp"

namespace glocal::conversion {

/// Where the reference moves otherwise than odometry from one scan to the next.
struct ReferenceJump {
  std::int64_t stamp_ns = 0;  ///< Of the scan after it.
  double distance_m = 0.0;    ///< Between what both say of the way.
  double angle_rad = 0.0;     ///< Between what both say of the turn.
};

/// Scans in a row, of those that have a reference, whose ways differ by more than 0.3 m and a tenth of the
/// way, or whose turns by more than 10 deg and a tenth of the turn.
[[nodiscard]] std::vector<ReferenceJump> reference_jumps(const std::vector<TrackedScan>& scans);

/// How far the clocks of odometry and reference are apart.
struct TimeShift {
  double shift_s = 0.0;  ///< To be added to the reference's stamps.
  /// Of speeds and turn rates by odometry and reference, in [-1, 1]: with this shift, and without.
  double correlation = 0.0, correlation_unshifted = 0.0;
};

/// Of up to 2 s. None where it cannot be told: fewer than 20 pairs of scans less than a second apart, a drive
/// of even speed without turns, or speeds that do not correlate.
[[nodiscard]] std::optional<TimeShift> time_shift_of(const DriveTrack& drive,
                                                     const ReferencePoses& references);

/// A pose of the robot in that of another time, measured by hand.
struct Relation {
  std::int64_t from_ns = 0, to_ns = 0;
  Pose3 from_robot_to_robot;
};

/// Lines of `t1 t2 x y z roll pitch yaw`; # begins a comment. Throws ConfigError, with the line, for others.
[[nodiscard]] std::vector<Relation> read_relations(const std::filesystem::path& file);

/// Errors of the reference's relative poses.
struct RelationErrors {
  std::size_t relations = 0;  ///< Both of whose poses are known.
  double mean_m = 0.0, p95_m = 0.0;
  double mean_rad = 0.0;
};

/// None if no relation has two poses of the reference that are at most `max_gap_ns` from its times.
[[nodiscard]] std::optional<RelationErrors> relation_errors(const std::vector<Relation>& relations,
                                                            const std::vector<TrackedScan>& scans,
                                                            std::int64_t max_gap_ns);

}  // namespace glocal::conversion
