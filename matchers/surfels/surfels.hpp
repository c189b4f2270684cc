// Clouds as small pieces of surface.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "glocal/local_map.hpp"
#include "glocal/points.hpp"

namespace glocal::surfels {

/// Pieces of surface: the mean of each voxel's points, where they and their neighbours lie in a plane.
struct Surfels {
  Points points;   ///< m
  Points normals;  ///< Unit length.
  /// How much each counts: the fewer share its direction, the more, for else the floor decides. They add up
  /// to the number of surfels.
  std::vector<float> weights;

  [[nodiscard]] std::size_t size() const { return points.size(); }
};

/// Surfels of a cloud in voxels of a side (m), turned to where it was seen from; without that to either side.
/// Normals are the direction in which the voxels' means within 2.5 voxels spread least, where these lie in a
/// plane; else of those within 5 voxels. Throws ConfigError if the cloud reaches too far (VoxelRegion).
[[nodiscard]] Surfels surfels_of(const Points& cloud, float voxel_size,
                                 const std::optional<Point>& seen_from);

/// The points of a local map that are at most 500 m and 2000 voxels from the robot: no lidar of a robot sees
/// farther, and of a few hits there the voxels would be too many for surfels_of().
[[nodiscard]] Points points_in_view(const LocalMap& local, float voxel_size);

}  // namespace glocal::surfels
