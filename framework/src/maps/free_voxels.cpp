#include "glocal/free_voxels.hpp"

#include <bit>
#include <cmath>

namespace glocal {
namespace {

/// The first voxel of a brick along an axis: 0 for columns, 1 for rows, 2 for layers.
int corner_of(std::uint64_t place, unsigned axis) {
  constexpr std::uint64_t of_axis = (std::uint64_t{1} << 21U) - 1;
  return static_cast<int>((place >> 21U * axis & of_axis) << 3U) - FreeVoxels::reach;
}

std::uint64_t place_of(int column, int row, int layer) {
  const auto brick = [](int voxel) { return static_cast<std::uint64_t>(voxel + FreeVoxels::reach) >> 3U; };
  return (brick(layer) << 21U | brick(row)) << 21U | brick(column);
}

std::uint64_t bit_of(int column, int row) {
  const auto within = [](int voxel) { return static_cast<unsigned>(voxel) & 7U; };
  return std::uint64_t{1} << (within(row) * 8U + within(column));
}

std::size_t layer_in_brick(int layer) {
  return static_cast<unsigned>(layer) & 7U;
}

}  // namespace

FreeVoxels::FreeVoxels(const Pose2& map_from_voxels, double side)
    : map_from_voxels_(map_from_voxels), side_(side), voxels_from_map_(inverse(map_from_voxels)) {}

void FreeVoxels::add(int column, int row, int layer) {
  const std::uint64_t place = place_of(column, row, layer);
  const auto [number, is_new] = numbers_.try_emplace(place, static_cast<std::uint32_t>(bricks_.size()));
  if (is_new) bricks_.push_back({place});
  bricks_[number->second].bits[layer_in_brick(layer)] |= bit_of(column, row);
}

void FreeVoxels::add_shifted(const FreeVoxels& other, int columns) {
  for (const auto& [place, layers] : other.bricks_) {
    for (std::size_t layer = 0; layer < layers.size(); ++layer) {
      for (std::uint64_t left = layers[layer]; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        add(corner_of(place, 0) + bit % 8 + columns, corner_of(place, 1) + bit / 8,
            corner_of(place, 2) + static_cast<int>(layer));
      }
    }
  }
}

bool FreeVoxels::contains(const Point& p) const {
  const Point q = voxels_from_map_(p);
  const std::array<double, 3> at = {q.x / side_, q.y / side_, q.z / side_};
  for (const double coordinate : at) {
    if (!(coordinate >= -reach && coordinate < reach)) return false;
  }
  const auto voxel = [&](std::size_t axis) { return static_cast<int>(std::floor(at[axis])); };
  const auto number = numbers_.find(place_of(voxel(0), voxel(1), voxel(2)));
  if (number == numbers_.end()) return false;
  return (bricks_[number->second].bits[layer_in_brick(voxel(2))] & bit_of(voxel(0), voxel(1))) != 0;
}

}  // namespace glocal
