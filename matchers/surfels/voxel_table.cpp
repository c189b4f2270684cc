#include "matchers/surfels/voxel_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "glocal/error.hpp"

namespace glocal::surfels {
namespace {

/// Smallest and largest value; (0, 0) of none.
std::pair<float, float> range_of(const std::vector<float>& values) {
  if (values.empty()) return {0.0F, 0.0F};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, *most};
}

}  // namespace

VoxelRegion::VoxelRegion(const Points& points, float side, int margin) : side_(side), scale_(1.0F / side) {
  constexpr double most_bricks = 134'217'728.0;
  const std::array<std::pair<float, float>, 3> ranges = {range_of(points.x), range_of(points.y),
                                                         range_of(points.z)};
  std::array<double, 3> bricks{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = ranges[axis];
    bricks[axis] = std::ceil((static_cast<double>(most - least) / side + 2.0 * margin + 2.0) / 8.0);
  }
  if (bricks[0] * bricks[1] * bricks[2] > most_bricks)
    throw ConfigError({{"", 0, 0,
                        fmt::format("points reach over {:.0f} m x {:.0f} m x {:.0f} m, too far for voxels of "
                                    "{} m; remove far points, or take larger voxels",
                                    ranges[0].second - ranges[0].first, ranges[1].second - ranges[1].first,
                                    ranges[2].second - ranges[2].first, side)}});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = static_cast<std::uint32_t>(8.0 * bricks[axis]);
    most_[axis] = static_cast<float>(size_[axis]);
  }
  const float around = static_cast<float>(margin) * side;
  min_ = {ranges[0].first - around, ranges[1].first - around, ranges[2].first - around};
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
