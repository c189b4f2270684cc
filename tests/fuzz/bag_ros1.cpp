// Bags of ROS 1.
#include "fuzz/bag.hpp"

extern "C" int fuzz_bag_ros1(const std::uint8_t* data, std::size_t size) {
  return glocal::fuzz::try_recording(data, size, "#ROS");
}
