#include "matchers/surfels/voxel_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"

namespace glocal::surfels {

VoxelRegion::VoxelRegion(const Points& points, float side, int margin) : side_(side), scale_(1.0F / side) {
  constexpr double most_bricks = 134'217'728.0;
  const std::array<Extent, 3> extents = {extent_of(points.x), extent_of(points.y), extent_of(points.z)};
  std::array<double, 3> bricks{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = extents[axis];
    bricks[axis] = std::ceil((static_cast<double>(high - low) / side + 2.0 * margin + 2.0) / 8.0);
  }
  // Where neighbouring numbers are farther apart than voxels, a point may come to lie outside of its own
  // region.
  float farthest = 0.0F;
  for (const Extent& extent : extents)
    farthest = std::max({farthest, std::abs(extent.low), std::abs(extent.high)});
  const float apart = std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest;
  if (!(apart <= side))
    throw ConfigError(
        "",
        fmt::format(
            "points lie up to {:.0f} m from the origin, where coordinates of 32 bits are {} m apart, too far "
            "for voxels of {} m; move the points nearer to the origin",
            farthest, apart, side));
  if (bricks[0] * bricks[1] * bricks[2] > most_bricks)
    throw ConfigError("",
                      fmt::format("points reach over {:.0f} m x {:.0f} m x {:.0f} m, too far for voxels of "
                                  "{} m; remove far points, or take larger voxels",
                                  extents[0].length(), extents[1].length(), extents[2].length(), side));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = static_cast<std::uint32_t>(8.0 * bricks[axis]);
    most_[axis] = static_cast<float>(size_[axis]);
  }
  const float around = static_cast<float>(margin) * side;
  min_ = {extents[0].low - around, extents[1].low - around, extents[2].low - around};
  brick_columns_ = static_cast<std::size_t>(bricks[0]);
  brick_rows_ = static_cast<std::size_t>(bricks[1]);
  brick_layers_ = static_cast<std::size_t>(bricks[2]);
}

std::uint32_t& VoxelTable::slot(const Voxel& v) {
  std::uint32_t& brick = bricks_[brick_of(v)];
  if (brick == none) {
    brick = static_cast<std::uint32_t>(voxels_.size() / voxels_per_brick);
    voxels_.resize(voxels_.size() + voxels_per_brick, none);
  }
  return voxels_[brick * voxels_per_brick + place_in_brick(v)];
}

}  // namespace glocal::surfels
