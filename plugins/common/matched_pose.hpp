// What a search by features finds.
#pragma once

#include <cstddef>

#include "glocal/pose3.hpp"

namespace glocal {

/// Clouds with fewer points, one for each voxel, are not registered.
inline constexpr std::size_t fewest_points = 10;

/// The pose of one cloud in another.
struct MatchedPose {
  Pose3 target_from_source;
  double overlap = 0.0;  ///< Share of the source's points within 1.5 voxels of the target's, in [0, 1].
  double rmse = 0.0;     ///< Of these points' distances, m.
};

}  // namespace glocal
