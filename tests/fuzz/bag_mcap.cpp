// MCAP recordings.
#include "fuzz/bag.hpp"

extern "C" int fuzz_bag_mcap(const std::uint8_t* data, std::size_t size) {
  return glocal::fuzz::try_recording(data, size, "\x89MCAP");
}
