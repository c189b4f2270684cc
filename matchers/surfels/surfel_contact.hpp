// Which surfel of a cloud a moved surfel lies on.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "matchers/surfels/surfels.hpp"
#include "matchers/surfels/voxel_table.hpp"

namespace glocal::surfels {

/// Of normals that may be of one surface: 41 degrees.
inline constexpr float least_cosine_of_normals = 0.755F;

/// Contact of surfels: a point within a voxel of the plane of the nearest surfel, which is at most two voxels
/// away, and with a normal that is turned by 41 degrees at most.
class SurfelContact {
 public:
  /// The plane of a surfel: all p with dot(normal, p) = distance.
  struct Plane {
    Point normal;
    float distance = 0.0F;  ///< m
  };

  /// Whether normals on both sides tell which side of a surface was seen: then surfels seen from opposite
  /// sides do not touch. Throws ConfigError if the cloud reaches too far (VoxelRegion).
  SurfelContact(const Surfels& surfels, float voxel_size, bool one_side);

  /// The nearest surfel, roughly; VoxelTable::none if none is near.
  [[nodiscard]] std::uint32_t nearest(const Point& p) const { return nearest_.at(p); }

  [[nodiscard]] const Plane& plane(std::uint32_t k) const { return planes_[k]; }
  /// Whether a point with a normal lies on surfel k.
  [[nodiscard]] bool lies_on(std::uint32_t k, const Point& p, const Point& normal) const {
    const Plane& plane = planes_[k];
    const float cosine = dot(plane.normal, normal);
    if ((one_side_ ? cosine : std::abs(cosine)) < least_cosine_of_normals) return false;
    return std::abs(dot(plane.normal, p) - plane.distance) < nearest_.side();
  }
  [[nodiscard]] bool touches(const Point& p, const Point& normal) const {
    const std::uint32_t k = nearest(p);
    return k != VoxelTable::none && lies_on(k, p, normal);
  }
  /// How far from the plane of a surfel a point may be, m.
  [[nodiscard]] float reach() const { return nearest_.side(); }
  [[nodiscard]] std::size_t memory_bytes() const {
    return nearest_.memory_bytes() + planes_.size() * sizeof(Plane);
  }

 private:
  std::vector<Plane> planes_;
  VoxelTable nearest_;
  bool one_side_;
};

}  // namespace glocal::surfels
