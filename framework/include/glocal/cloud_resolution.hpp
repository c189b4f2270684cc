// How finely clouds are sampled.
#pragma once

#include "glocal/points.hpp"

namespace glocal {

/// The side (m) of voxels that suits two clouds: the smallest that has three to four points in each voxel
/// with any, and no more voxels than are worth the time; the mean of both clouds'. Powers of the fourth root
/// of two, so that a few points more or less change nothing.
[[nodiscard]] float cloud_resolution(const Points& a, const Points& b);

/// The side (m) of voxels that suits a map whose points are so far apart (m; 0 if not known): three times
/// that, and at least 0.1 m.
[[nodiscard]] double map_voxel_size(double resolution);

}  // namespace glocal
