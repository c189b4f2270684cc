// A number for each voxel of a region, kept only where there is something.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "glocal/points.hpp"

namespace glocal::surfels {

/// A voxel's column, row and layer.
struct Voxel {
  std::int32_t x = 0, y = 0, z = 0;
};

/// A region of space, cut into voxels, and these into bricks of 8 x 8 x 8.
class VoxelRegion {
 public:
  static constexpr std::size_t voxels_per_brick = 512;

  /// Of the points' region and `margin` voxels around it. Throws ConfigError if the region has more than
  /// 2^36 voxels.
  VoxelRegion(const Points& points, float side, int margin);

  [[nodiscard]] float side() const { return side_; }
  [[nodiscard]] std::size_t bricks() const { return brick_columns_ * brick_rows_ * brick_layers_; }
  /// Of a point within the region.
  [[nodiscard]] Voxel voxel_of(const Point& p) const {
    const auto cell = [&](float v, float least) { return static_cast<std::int32_t>((v - least) * scale_); };
    return {cell(p.x, min_.x), cell(p.y, min_.y), cell(p.z, min_.z)};
  }
  [[nodiscard]] Point centre_of(const Voxel& v) const {
    const auto at = [&](float least, std::int32_t cell) {
      return least + (static_cast<float>(cell) + 0.5F) * side_;
    };
    return {at(min_.x, v.x), at(min_.y, v.y), at(min_.z, v.z)};
  }
  /// Whether a point is within the region; not for NaN.
  [[nodiscard]] bool contains(const Point& p) const {
    const float x = (p.x - min_.x) * scale_;
    const float y = (p.y - min_.y) * scale_;
    const float z = (p.z - min_.z) * scale_;
    return x >= 0.0F && x < most_[0] && y >= 0.0F && y < most_[1] && z >= 0.0F && z < most_[2];
  }
  [[nodiscard]] bool contains(const Voxel& v) const {
    return static_cast<std::uint32_t>(v.x) < size_[0] && static_cast<std::uint32_t>(v.y) < size_[1] &&
           static_cast<std::uint32_t>(v.z) < size_[2];
  }
  /// Of a voxel within the region.
  [[nodiscard]] std::size_t brick_of(const Voxel& v) const {
    return (static_cast<std::size_t>(v.z >> 3) * brick_rows_ + static_cast<std::size_t>(v.y >> 3)) *
               brick_columns_ +
           static_cast<std::size_t>(v.x >> 3);
  }
  [[nodiscard]] static std::size_t place_in_brick(const Voxel& v) {
    return static_cast<std::size_t>((v.z & 7) << 6 | (v.y & 7) << 3 | (v.x & 7));
  }

 private:
  float side_, scale_;
  Point min_;                            ///< Outer corner of voxel (0, 0, 0).
  std::array<std::uint32_t, 3> size_{};  ///< Voxels along each axis.
  std::array<float, 3> most_{};          ///< The same, to compare with.
  std::size_t brick_columns_ = 0, brick_rows_ = 0, brick_layers_ = 0;
};

/// Numbers of a region's voxels. Only bricks in which a number was set take memory; finding a number takes
/// two steps, whatever the size of the region.
class VoxelTable : public VoxelRegion {
 public:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  explicit VoxelTable(const VoxelRegion& region) : VoxelRegion(region), bricks_(region.bricks(), none) {}

  /// Where to write the number of a voxel that is within the region.
  [[nodiscard]] std::uint32_t& slot(const Voxel& v);
  /// The number of the voxel that a point is in, or `none`; so for points anywhere, and for NaN.
  [[nodiscard]] std::uint32_t at(const Point& p) const { return contains(p) ? number(voxel_of(p)) : none; }
  /// The voxel's number, or `none`.
  [[nodiscard]] std::uint32_t at(const Voxel& v) const { return contains(v) ? number(v) : none; }

  [[nodiscard]] std::size_t memory_bytes() const {
    return (bricks_.size() + voxels_.size()) * sizeof(std::uint32_t);
  }

 private:
  [[nodiscard]] std::uint32_t number(const Voxel& v) const {
    const std::uint32_t brick = bricks_[brick_of(v)];
    return brick == none ? none : voxels_[brick * voxels_per_brick + place_in_brick(v)];
  }

  std::vector<std::uint32_t> bricks_;  ///< The number of each brick of the region, or `none`.
  std::vector<std::uint32_t> voxels_;  ///< The numbers of the voxels, brick by brick.
};

}  // namespace glocal::surfels
