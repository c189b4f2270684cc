// The pose of one cloud in another, for programs that embed glocal: link glocal::builtin.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// How two clouds are registered.
struct RegistrationOptions {
  std::optional<double> voxel_size;  ///< m; made from the clouds unless given.
  /// Where the sensor stood in each cloud's frame. A cloud that cannot have been seen from there, as points
  /// hide each other, counts as one of which that is not known.
  Point source_seen_from;
  Point target_seen_from;
  std::uint64_t seed = 42;
};

/// What a registration came to.
struct Registration {
  /// Whether the pose can be trusted; `why` says what speaks for or against it, in a sentence.
  bool is_match = false;
  std::string why;
  /// The best pose found, trusted or not; none if nothing in the clouds fixes one.
  std::optional<Pose3> target_from_source;
  /// The smaller one of the two shares of surfels that lie on surfels of the other cloud, in [0, 1].
  double overlap = 0.0;
  double rmse = 0.0;        ///< Of these surfels' distances from the planes of those they lie on, m.
  double score = 0.0;       ///< Share of surfels in contact, less five times the share that was seen through.
  double lead = 0.0;        ///< How much higher the score is than that of the next best pose.
  double voxel_size = 0.0;  ///< m
  bool sensors_known = false;  ///< Whether both clouds were taken as seen from one place each.
};

/// The pose of one cloud in another, whatever it is turned by, without any guess. The same clouds and options
/// give the same answer, bit for bit. Clouds are not empty and hold finite numbers only. Throws ConfigError
/// if they reach too far for their voxels.
[[nodiscard]] Registration register_clouds(const Points& source, const Points& target,
                                           const RegistrationOptions& options = {});

}  // namespace glocal
