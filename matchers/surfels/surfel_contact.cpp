#include "matchers/surfels/surfel_contact.hpp"

namespace glocal::surfels {
namespace {

VoxelTable nearest_surfels(const Surfels& surfels, float voxel_size) {
  constexpr int margin = 2;
  const VoxelRegion region(surfels.points, voxel_size, margin);
  VoxelTable nearest(region);
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const Point p = surfels.points[i];
    const Voxel centre = region.voxel_of(p);
    for (std::int32_t z = centre.z - 1; z <= centre.z + 1; ++z) {
      for (std::int32_t y = centre.y - 1; y <= centre.y + 1; ++y) {
        for (std::int32_t x = centre.x - 1; x <= centre.x + 1; ++x) {
          std::uint32_t& slot = nearest.slot({x, y, z});
          const Point middle = region.centre_of({x, y, z});
          const auto squared = [&](const Point& q) { return dot(q - middle, q - middle); };
          if (slot == VoxelTable::none || squared(p) < squared(surfels.points[slot]))
            slot = static_cast<std::uint32_t>(i);
        }
      }
    }
  }
  return nearest;
}

}  // namespace

SurfelContact::SurfelContact(const Surfels& surfels, float voxel_size, bool one_side)
    : nearest_(nearest_surfels(surfels, voxel_size)), one_side_(one_side) {
  planes_.reserve(surfels.size());
  for (std::size_t i = 0; i < surfels.size(); ++i)
    planes_.push_back({surfels.normals[i], dot(surfels.normals[i], surfels.points[i])});
}

}  // namespace glocal::surfels
