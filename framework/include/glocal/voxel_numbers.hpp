// Numbers for the voxels that have something in them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glocal {

/// Voxels by their indices along x, y and z, numbered from 0 as they come: a hash table with open addressing,
/// at most half full.
template <class Index>
class VoxelNumbers {
 public:
  using Voxel = std::array<Index, 3>;
  static constexpr std::uint32_t none = 0xffffffff;

  /// With room for so many; it grows.
  explicit VoxelNumbers(std::size_t expected = 511) : slots_(std::bit_ceil(2 * expected + 1), none) {}

  [[nodiscard]] std::uint32_t find(const Voxel& voxel) const { return slots_[slot_of(voxel)]; }
  std::uint32_t find_or_add(const Voxel& voxel) {
    const std::size_t slot = slot_of(voxel);
    if (slots_[slot] != none) return slots_[slot];
    const auto number = static_cast<std::uint32_t>(voxels_.size());
    slots_[slot] = number;
    voxels_.push_back(voxel);
    if (2 * voxels_.size() > slots_.size()) {
      slots_.assign(2 * slots_.size(), none);
      for (std::uint32_t i = 0; i < voxels_.size(); ++i) slots_[slot_of(voxels_[i])] = i;
    }
    return number;
  }
  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  void clear() {
    slots_.assign(slots_.size(), none);
    voxels_.clear();
  }

 private:
  /// Where the voxel is, or would be.
  [[nodiscard]] std::size_t slot_of(const Voxel& voxel) const {
    std::uint64_t hash = 0;
    for (const Index index : voxel) hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15U;
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = (hash >> 32U) & mask;  // The upper bits of a product are the well mixed ones.
    while (slots_[slot] != none && voxels_[slots_[slot]] != voxel) slot = (slot + 1) & mask;
    return slot;
  }

  std::vector<std::uint32_t> slots_;  ///< The number of the voxel there, or none.
  std::vector<Voxel> voxels_;
};

}  // namespace glocal
