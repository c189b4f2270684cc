#include "glocal/voxel_filter.hpp"

#include "glocal/rounded_down.hpp"
#include "glocal/voxel_numbers.hpp"

namespace glocal {

VoxelGroups voxel_groups(const Points& points, double side) {
  VoxelNumbers<std::int64_t> numbers(points.size());
  VoxelGroups groups;
  groups.of_point.reserve(points.size());
  const double per_metre = 1.0 / side;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = points[i];
    const auto voxel = [&](float value) { return rounded_down<std::int64_t>(value * per_metre); };
    groups.of_point.push_back(numbers.find_or_add({voxel(p.x), voxel(p.y), voxel(p.z)}));
  }
  groups.count = numbers.size();
  return groups;
}

Points means_of_groups(const Points& points, const VoxelGroups& groups) {
  struct Sum {
    double x = 0.0, y = 0.0, z = 0.0, points = 0.0;
  };
  std::vector<Sum> sums(groups.count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Sum& sum = sums[groups.of_point[i]];
    sum.x += points.x[i];
    sum.y += points.y[i];
    sum.z += points.z[i];
    sum.points += 1.0;
  }
  Points means;
  means.reserve(groups.count);
  for (const Sum& sum : sums)
    means.push_back({static_cast<float>(sum.x / sum.points), static_cast<float>(sum.y / sum.points),
                     static_cast<float>(sum.z / sum.points)});
  return means;
}

}  // namespace glocal
