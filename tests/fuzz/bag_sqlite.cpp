// Bags of ROS 2 in SQLite.
#include "fuzz/bag.hpp"

extern "C" int fuzz_bag_sqlite(const std::uint8_t* data, std::size_t size) {
  return glocal::fuzz::try_recording(data, size, "SQLite format 3");
}
