#include "report/thinning.hpp"

#include <algorithm>
#include <numbers>

#include "glocal/voxel_filter.hpp"

namespace glocal {
namespace {

constexpr double finest = 0.02;  // m

/// Real points, not means: those stay where they are when others join them.
Points first_of_groups(const Points& points, const VoxelGroups& groups) {
  Points first;
  first.reserve(groups.count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (groups.of_point[i] == first.size()) first.push_back(points[i]);
  }
  return first;
}

}  // namespace

Points thinned_in_space(const Points& points, std::size_t most) {
  const bool is_flat = std::all_of(points.z.begin(), points.z.end(), [](float z) { return z == 0.0F; });
  if (is_flat || points.size() <= most) return points;
  double side = finest;
  VoxelGroups groups = voxel_groups(points, side);
  while (groups.count > most) {
    side *= std::numbers::sqrt2;
    groups = voxel_groups(points, side);
  }
  return first_of_groups(points, groups);
}

}  // namespace glocal
