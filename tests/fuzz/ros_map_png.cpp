// Maps of a map server whose image is a PNG file. The checksums of its chunks are repaired: otherwise nothing
// else would ever be read.
#include <zlib.h>

#include "fuzz/harness.hpp"
#include "sources/ros_map/ros_map.hpp"

namespace {

constexpr std::size_t signature_size = 8;
constexpr std::size_t frame_size = 12;  // of a chunk: length, type, checksum

std::uint32_t number_at(const std::string& text, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(text[at + i]);
  return value;
}

std::string repaired(std::string png) {
  for (std::size_t at = signature_size; at + frame_size <= png.size();) {
    const std::size_t length = number_at(png, at);
    if (length > png.size() - at - frame_size) break;
    const auto* const begin = reinterpret_cast<const Bytef*>(png.data()) + at + 4;
    const auto checksum = static_cast<std::uint32_t>(crc32(0, begin, static_cast<uInt>(length + 4)));
    for (std::size_t i = 0; i < 4; ++i)
      png[at + 8 + length + i] = static_cast<char>(checksum >> (24U - 8U * i) & 0xFFU);
    at += frame_size + length;
  }
  return png;
}

}  // namespace

extern "C" int fuzz_ros_map_png(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  static const auto map =
      fuzz::write("map.yaml", "image: map.png\nresolution: 0.05\norigin: [0, 0, 0]\nmode: scale\n");
  fuzz::write("map.png", repaired(fuzz::text_of(data, size)));
  return fuzz::answer([&] { static_cast<void>(ros_map::RosMap({{map.string(), map}}, {}).load()); });
}
