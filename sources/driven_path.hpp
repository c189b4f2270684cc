// The path of a recorded drive: which parts of it are used, and where it led.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "glocal/params.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// Parts of a drive, as [from, to] shares of its path.
using PathSegments = std::vector<std::array<double, 2>>;

/// The field `segments`, for everything that reads recorded drives, and its rule.
void describe_segments(ParamVisitor& v, PathSegments& segments);
void require_rising(ParamVisitor& v, const PathSegments& segments);

/// The indexes of the observations on each segment, [from, to[ of the path; its very end belongs to a segment
/// that ends at 1. `lengths` are those of the path up to each observation, in any unit. Throws ConfigError at
/// `file` with all segments that have none; `what` an observation is called there.
[[nodiscard]] std::vector<std::vector<std::size_t>> places_on(const PathSegments& segments,
                                                              const std::vector<double>& lengths,
                                                              const std::string& file,
                                                              const std::string& what);

/// Which observations of a drive are used.
struct KeyframeRule {
  double distance = 0.25;    ///< m
  double angle_deg = 11.46;  ///< 0.2 rad
};

/// The fields `keyframe_distance` and `keyframe_angle_deg`.
void describe_keyframes(ParamVisitor& v, KeyframeRule& rule);

/// Whether the robot has moved or turned far enough since the last observation that was used.
[[nodiscard]] bool is_keyframe(const Pose3& last, const Pose3& now, const KeyframeRule& rule);

/// Poses of a path at least 0.25 m apart.
[[nodiscard]] std::vector<Pose3> sparse_path(const std::vector<Pose3>& path);

}  // namespace glocal
