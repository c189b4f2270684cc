// OctoMap's binary trees.
#include "fuzz/cloud.hpp"
#include "sources/clouds/cloud_formats.hpp"

extern "C" int fuzz_cloud_octree(const std::uint8_t* data, std::size_t size) {
  // A few bytes may stand for as many voxels as are allowed.
  return glocal::fuzz::try_cloud(data, size, glocal::clouds::read_octree_cloud, {.max_size_gb = 0.01});
}
