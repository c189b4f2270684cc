#include "sources/clouds/cloud_voxels.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"
#include "sources/grid_ray.hpp"

namespace glocal::clouds {

CloudVoxels::CloudVoxels(const Cloud& cloud, double side, const std::string& file)
    : side_(cloud.voxel_size > 0.0 ? cloud.voxel_size : side) {
  const Points& points = cloud.points;
  const Extent x = extent_of(points.x), y = extent_of(points.y), z = extent_of(points.z);
  const auto cubes = [&](const Extent& along) { return std::floor((along.high - along.low) / side_) + 1.0; };
  constexpr double most_cubes = 4e9;
  if (!(cubes(x) * cubes(y) * cubes(z) <= most_cubes)) {
    throw ConfigError(
        file, fmt::format("its extent is more than 4000 million cubes of {} m; cut it smaller, or, if it "
                          "is no octree, raise cloud_voxel_size",
                          side_));
  }
  // Points of an octree lie in the middle of its voxels.
  const double margin = cloud.voxel_size / 2.0;
  corner_ = {x.low - margin, y.low - margin, z.low - margin};
  // One more than needed, as the farthest point may be rounded into the next.
  size_ = {static_cast<int>(cubes(x)) + 1, static_cast<int>(cubes(y)) + 1, static_cast<int>(cubes(z)) + 1};
  occupied_.resize(index_of({size_[0] - 1, size_[1] - 1, size_[2] - 1}) + 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = in_cubes({points.x[i], points.y[i], points.z[i]});
    occupied_[index_of({static_cast<int>(at[0]), static_cast<int>(at[1]), static_cast<int>(at[2])})] = true;
  }
}

double CloudVoxels::ray_distance(const Vector3& origin, const Vector3& direction, double reach) const {
  // Looked at from beyond the last cube that matters, as rays stop before the cube they end in.
  const double length = reach + 2.0 * side_;
  double distance = std::numeric_limits<double>::infinity();
  visit_cells_before_end<3>(in_cubes(origin), in_cubes(origin + length * direction),
                            [&](const Cube& cube, double share) {
                              if (!holds(cube) || !occupied_[index_of(cube)]) return true;
                              distance = share * length;
                              return false;
                            });
  return distance <= reach ? distance : std::numeric_limits<double>::infinity();
}

Vector3 CloudVoxels::centre_near(const Vector3& place) const {
  const auto at = in_cubes(place);
  const auto centre = [&](double in_cubes) { return (std::floor(in_cubes) + 0.5) * side_; };
  return corner_ + Vector3{centre(at[0]), centre(at[1]), centre(at[2])};
}

bool CloudVoxels::is_occupied(const Vector3& place) const {
  Cube cube{};
  const auto at = in_cubes(place);
  for (std::size_t axis = 0; axis < cube.size(); ++axis) {
    // Negated so that NaN falls outside.
    if (!(at[axis] >= 0.0 && at[axis] < size_[axis])) return false;
    cube[axis] = static_cast<int>(at[axis]);
  }
  return occupied_[index_of(cube)];
}

std::array<double, 3> CloudVoxels::in_cubes(const Vector3& place) const {
  const Vector3 from_corner = place - corner_;
  return {from_corner.x() / side_, from_corner.y() / side_, from_corner.z() / side_};
}

bool CloudVoxels::holds(const Cube& cube) const {
  for (std::size_t axis = 0; axis < cube.size(); ++axis) {
    if (cube[axis] < 0 || cube[axis] >= size_[axis]) return false;
  }
  return true;
}

std::size_t CloudVoxels::index_of(const Cube& cube) const {
  const auto at = [](int number) { return static_cast<std::size_t>(number); };
  return (at(cube[2]) * at(size_[1]) + at(cube[1])) * at(size_[0]) + at(cube[0]);
}

}  // namespace glocal::clouds
