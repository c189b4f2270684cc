// PLY files of maps and scans.
#include "fuzz/cloud.hpp"
#include "sources/clouds/cloud_formats.hpp"

extern "C" int fuzz_cloud_ply(const std::uint8_t* data, std::size_t size) {
  return glocal::fuzz::try_cloud(data, size, glocal::clouds::read_ply_cloud);
}
