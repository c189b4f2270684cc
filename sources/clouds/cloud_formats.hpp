// The formats of clouds: readers of one each.
#pragma once

#include <string>
#include <string_view>

#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// Whether a file that begins so is a PCD file.
[[nodiscard]] bool is_pcd(std::string_view content);

/// A PCD file (Point Cloud Library), versions .5 to .7: DATA ascii, binary and binary_compressed; any fields
/// besides x, y and z, each of any type. Throws ConfigError, with the line or the number of the point, if
/// this is no such cloud, if the header announces something else than is there, or if the points have more
/// than the options allow when decompressed.
[[nodiscard]] Cloud read_pcd_cloud(std::string_view content, const std::string& file,
                                   const CloudOptions& options);

/// Whether a file that begins so is a PLY file.
[[nodiscard]] bool is_ply(std::string_view content);

/// A PLY file (Stanford), version 1.0: the vertices, whatever else there is. Text and binary of both byte
/// orders. Throws ConfigError, with the line or the number of the point, if this is no such cloud or ends
/// before its last vertex.
[[nodiscard]] Cloud read_ply_cloud(std::string_view content, const std::string& file,
                                   const CloudOptions& options);

/// A cloud as the KITTI data set has them (velodyne, *.bin): x y z intensity, float32 little-endian. Throws
/// ConfigError, with the number of the point, if this is no such cloud.
[[nodiscard]] Cloud read_kitti_cloud(std::string_view content, const std::string& file,
                                     const CloudOptions& options);

/// Whether a file that begins so is a tree of OctoMap, binary or with probabilities.
[[nodiscard]] bool is_octree(std::string_view content);

/// OctoMap's binary tree (*.bt), whose voxels are occupied, free or unknown: the centres of all occupied
/// voxels of the finest size, in the tree's frame; what is free is passed over. Throws ConfigError, with the
/// line of the header or the byte of the file, if this is no binary OcTree, if its nodes are other than its
/// header says, or if its occupied voxels have more than the options allow.
[[nodiscard]] Cloud read_octree_cloud(std::string_view content, const std::string& file,
                                      const CloudOptions& options);

}  // namespace glocal::clouds
