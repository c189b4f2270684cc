// Maps of a map server: the YAML file, a line of dashes, the image (PGM, or anything).
#include "sources/ros_map/ros_map.hpp"

#include "fuzz/harness.hpp"

extern "C" int fuzz_ros_map(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto parts = fuzz::parts(fuzz::text_of(data, size), 2);
  const auto file = fuzz::write("map.yaml", parts[0]);
  fuzz::write("map.image", parts[1]);
  return fuzz::answer([&] { static_cast<void>(ros_map::RosMap({{file.string(), file}}, {}).load()); });
}
