// "Is there a point of the map within epsilon?" (contact_B of eq. 4), answered in constant time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/points.hpp"

namespace glocal {

/// The map's points dilated by epsilon, one bit per voxel of side epsilon / 4; a planar map has a single layer.
/// A voxel is in contact if its centre is within epsilon of a point, so an answer can differ from the exact one only for
/// distances within half a voxel's diagonal (0.18 epsilon in the plane) of epsilon.
class ContactGrid {
 public:
  /// Throws ConfigError if the grid would need more than 1 GiB.
  ContactGrid(const Points& points, double epsilon);

  /// The grid of a map for an epsilon, built once per map.
  [[nodiscard]] static std::shared_ptr<const ContactGrid> of(const GlobalMap& map, double epsilon);

  [[nodiscard]] bool contact(const Point& p) const {
    const int column = static_cast<int>((p.x - min_x_) * scale_);
    const int row = static_cast<int>((p.y - min_y_) * scale_);
    const int layer = static_cast<int>((p.z - min_z_) * scale_);
    // The outermost voxels are never in contact, so truncation of values in ]-1, 0[ to 0 does no harm.
    if (static_cast<unsigned>(column) >= columns_ || static_cast<unsigned>(row) >= rows_ ||
        static_cast<unsigned>(layer) >= layers_) {
      return false;
    }
    const std::size_t bit =
        (static_cast<std::size_t>(layer) * rows_ + static_cast<unsigned>(row)) * stride_ + static_cast<unsigned>(column);
    return ((bits_[bit >> 6U] >> (bit & 63U)) & 1U) != 0;
  }

  [[nodiscard]] std::size_t memory_bytes() const { return bits_.size() * sizeof(std::uint64_t); }

 private:
  float min_x_ = 0.0F, min_y_ = 0.0F, min_z_ = 0.0F;
  float scale_ = 0.0F;  ///< Voxels per metre.
  unsigned columns_ = 0, rows_ = 0, layers_ = 0;
  std::size_t stride_ = 0;  ///< Bits from a row to the next.
  std::vector<std::uint64_t> bits_;
};

}  // namespace glocal
