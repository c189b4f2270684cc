// Clouds of the KITTI data set.
#include "fuzz/cloud.hpp"
#include "sources/clouds/cloud_formats.hpp"

extern "C" int fuzz_cloud_kitti(const std::uint8_t* data, std::size_t size) {
  return glocal::fuzz::try_cloud(data, size, glocal::clouds::read_kitti_cloud);
}
