#include "fuzz/drawn_files.hpp"

#include <array>

#include "fuzz/harness.hpp"
#include "octree_files.hpp"
#include "sources/bags/recordings.hpp"

namespace glocal::fuzz {
namespace {

using test::bags::le;

std::string drawn_ros_map(Draw& draw) {
  const std::size_t width = 3 + draw.one_of(12);
  std::string image = "P5 " + std::to_string(width) + " " + std::to_string(width) + " 255\n";
  for (std::size_t i = 0; i < width * width; ++i)
    image += static_cast<char>(i < width || i % width == 0 ? 0 : draw.number<std::uint8_t>(255));
  write("map.pgm", image);
  std::string yaml = "image: map.pgm\nresolution: " + draw.digits(0.5) + "\norigin: [";
  yaml += draw.digits(-1.0) + ", " + draw.digits(-1.0) + ", " + draw.digits(0.0) + "]\n";
  yaml += "free_thresh: " + draw.digits(0.2) + "\noccupied_thresh: " + draw.digits(0.65) + "\n";
  return write("map.yaml", yaml).string();
}

/// Points on the walls of a room.
std::array<float, 3> drawn_point(Draw& draw, std::size_t i) {
  const float along = 0.1F * static_cast<float>(i % 40);
  const std::array<float, 3> on_wall =
      i % 2 == 0 ? std::array{along, 0.0F, 0.5F} : std::array{0.0F, along, 1.0F};
  return {draw.number(on_wall[0]), draw.number(on_wall[1]), draw.number(on_wall[2])};
}

std::string drawn_ply(Draw& draw) {
  const std::size_t points = 1 + draw.byte();
  std::string data;
  for (std::size_t i = 0; i < points; ++i) {
    for (const float v : drawn_point(draw, i)) data += le(v);
    for (const float v : {0.0F, 1.0F, 0.0F}) data += le(draw.number(v));
  }
  return write("map.ply", "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points) +
                              "\nproperty float x\nproperty float y\nproperty float z\n"
                              "property float nx\nproperty float ny\nproperty float nz\nend_header\n" +
                              data)
      .string();
}

std::string drawn_octree(Draw& draw) {
  std::vector<test::TreeLeaf> leaves;
  for (std::size_t i = 0; i < 1U + draw.byte() % 32U; ++i)
    leaves.push_back({.x = draw.number<std::uint16_t>(static_cast<std::uint16_t>(32768 + i)),
                      .y = draw.number<std::uint16_t>(32768),
                      .z = draw.number<std::uint16_t>(32768),
                      .log_odds = draw.byte() % 2 == 0 ? 1.0F : -1.0F});
  std::string tree = test::bt_file(leaves, 0.1);
  const std::size_t resolution = tree.find("res ") + 4;
  tree.replace(resolution, tree.find('\n', resolution) - resolution, draw.digits(0.1));
  return write("map.bt", tree).string();
}

}  // namespace

std::string drawn_pcd(Draw& draw, const std::string& name) {
  const std::size_t points = 1 + draw.byte();
  const bool is_binary = draw.byte() % 2 == 0;
  std::string head = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                     std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT";
  for (const double v : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}) head += " " + draw.digits(v);
  std::string data;
  for (std::size_t i = 0; i < points; ++i) {
    for (const float v : drawn_point(draw, i)) data += is_binary ? le(v) : std::to_string(v) + " ";
    if (!is_binary) data += "\n";
  }
  return write(name, head + "\nPOINTS " + std::to_string(points) + "\nDATA " +
                         (is_binary ? "binary\n" : "ascii\n") + data)
      .string();
}

std::string drawn_log(Draw& draw) {
  std::string log;
  for (int i = 0; i < 3; ++i) {
    log += "FLASER 8";
    for (int beam = 0; beam < 8; ++beam) log += " " + draw.digits(1.0 + 0.1 * beam);
    for (int pose = 0; pose < 2; ++pose)
      log += " " + draw.digits(0.1 * i) + " " + draw.digits(0.0) + " " + draw.digits(0.1 * i);
    log += " " + draw.digits(100.0 + 0.1 * i) + " host " + draw.digits(0.1 * i) + "\n";
  }
  return write("drive.log", log).string();
}

DrawnMap drawn_map(Draw& draw) {
  switch (draw.one_of(4)) {
    case 0:
      return {drawn_ros_map(draw), "ros_map: {path: map.yaml}"};
    case 1:
      return {drawn_pcd(draw, "map.pcd"), "point_cloud: {path: map.pcd}"};
    case 2:
      return {drawn_ply(draw), "point_cloud: {path: map.ply}"};
    default:
      return {drawn_octree(draw), "point_cloud: {path: map.bt}"};
  }
}

}  // namespace glocal::fuzz
