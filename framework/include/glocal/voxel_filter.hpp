// Fewer points of a cloud: one for each voxel that has any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/points.hpp"

namespace glocal {

/// Which points share a voxel. Voxels are numbered in the order of their first points.
struct VoxelGroups {
  std::vector<std::uint32_t> of_point;
  std::size_t count = 0;
};

/// Voxels are cubes of this side (m, above 0), one of them with a corner in the origin.
[[nodiscard]] VoxelGroups voxel_groups(const Points& points, double side);

/// The mean of each group's points.
[[nodiscard]] Points means_of_groups(const Points& points, const VoxelGroups& groups);

/// The mean of each voxel's points.
[[nodiscard]] inline Points voxel_downsampled(const Points& points, double side) {
  return means_of_groups(points, voxel_groups(points, side));
}

}  // namespace glocal
