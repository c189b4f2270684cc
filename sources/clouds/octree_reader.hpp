// Clouds as OctoMap's binary trees (*.bt): voxels that are occupied, free or unknown.
#pragma once

#include <string>
#include <string_view>

#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// Whether a file that begins so is a tree of OctoMap, binary or with probabilities.
[[nodiscard]] bool is_octree(std::string_view content);

/// The centres of all occupied voxels of the finest size, in the tree's frame; what is free is passed over.
/// Throws ConfigError, with the line of the header or the byte of the file, if this is no binary OcTree, if
/// its nodes are other than its header says, or if its occupied voxels have more than the options allow.
[[nodiscard]] Cloud read_octree_cloud(std::string_view content, const std::string& file,
                                      const CloudOptions& options);

}  // namespace glocal::clouds
