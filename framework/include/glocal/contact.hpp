// "Is there a point of the map within epsilon?" (contact_B of eq. 4), answered in constant time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/points.hpp"

namespace glocal {

/// The map's points dilated by epsilon, one bit per voxel of side epsilon / 4. A planar map (all points of
/// one height) has a single layer, which takes in everything within epsilon of that height. A voxel is in
/// contact if its centre is within epsilon of a point, so an answer can differ from the exact one only where
/// the distance is within half a voxel's diagonal of epsilon (0.18 epsilon in the plane).
class ContactGrid {
 public:
  /// Throws ConfigError if the grid would need more than 1 GiB.
  ContactGrid(const Points& points, double epsilon);

  /// The grid of a map for an epsilon, built once per map.
  [[nodiscard]] static std::shared_ptr<const ContactGrid> of(const GlobalMap& map, double epsilon);

  [[nodiscard]] bool contact(const Point& p) const {
    const float x = (p.x - min_.x) * scale_;
    const float y = (p.y - min_.y) * scale_;
    const float z = (p.z - min_.z) * scale_z_;
    // Compared as floats, so that points far away and NaN never reach the conversion to integers.
    if (!(x >= 0.0F && x < columns_ && y >= 0.0F && y < rows_ && z >= 0.0F && z < layers_)) return false;
    const std::size_t bit =
        bit_index(static_cast<std::size_t>(x), static_cast<std::size_t>(y), static_cast<std::size_t>(z));
    return ((bits_[bit >> 6U] >> (bit & 63U)) & 1U) != 0;
  }

  [[nodiscard]] std::size_t memory_bytes() const { return bits_.size() * sizeof(std::uint64_t); }

 private:
  [[nodiscard]] std::size_t bit_index(std::size_t column, std::size_t row, std::size_t layer) const {
    return layer * layer_stride_ + row * row_stride_ + column;
  }
  void dilate(const Point& p, double epsilon);

  Point min_;                            ///< Outer corner of voxel (0, 0, 0).
  float scale_ = 0.0F, scale_z_ = 0.0F;  ///< Voxels per metre.
  float columns_ = 0, rows_ = 0,
        layers_ = 0;  ///< Numbers of voxels; whole, but only ever compared with floats.
  std::size_t row_stride_ = 0, layer_stride_ = 0;
  std::vector<std::uint64_t> bits_;
};

}  // namespace glocal
