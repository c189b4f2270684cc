// The inner loop of BitsetContact, compiled for each instruction set and chosen when the program runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "glocal/contact.hpp"

namespace glocal {

/// Bits of voxels: 32 of a row in each word; rows, then layers.
struct VoxelBits {
  const std::uint32_t* words;
  /// Words in a row and in a layer, or bricks in them.
  std::uint32_t row_words, layer_words;
  /// Where the words of each brick begin; null where the bits are not in bricks.
  const std::uint32_t* bricks = nullptr;
};

/// A brick of voxels is a word long and has so many rows and layers.
constexpr unsigned brick_shift = 3;
constexpr std::size_t brick_words = std::size_t{1} << (2 * brick_shift);

/// A grid of bits and where it lies.
struct VoxelGrid {
  /// A coarse voxel joins 4 x 4 x 4 and is set if one of them is.
  static constexpr unsigned coarse_shift = 2;

  VoxelBits fine;
  VoxelBits coarse;
  float columns, rows, layers;  ///< Of the fine voxels; whole numbers.
  Point min;                    ///< Outer corner of voxel (0, 0, 0).
  float scale, scale_z;         ///< Voxels per metre.
};

struct PointRun {
  const float *x, *y, *z;
  std::size_t size;
};

/// ContactIndex::count_while(). Reads no point beyond the run. The answer is the same for all instruction
/// sets. Timed by bench_contact and bench_extrapolation.
[[nodiscard]] ContactIndex::Count count_contacts(const VoxelGrid& grid, const Transform& map_from_points,
                                                 const PointRun& points, std::size_t batch,
                                                 std::span<const std::uint32_t> least);

/// ContactIndex::count_at_most(), by the coarse bits: one pose in each lane of a vector.
void count_coarse(const VoxelGrid& grid, const Points& points, std::size_t n, const MotionBatch& motions,
                  std::size_t size, const ContactIndex::BatchColumn& begins,
                  ContactIndex::BatchColumn& at_most);

}  // namespace glocal
