// The voxels of a cloud of points, for casting rays.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "glocal/pose3.hpp"
#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// Cubes over the extent of a cloud: occupied where there are points, empty elsewhere. A bit for each.
class CloudVoxels {
 public:
  /// The voxels of an octree as they are; of another cloud cubes of this `side`, m. `file` is the cloud's.
  /// Throws ConfigError if there would be too many cubes.
  CloudVoxels(const Cloud& cloud, double side, const std::string& file);

  /// Distance from a place along a unit vector to where the ray enters an occupied cube, m; infinite if there
  /// is none within `reach` (m).
  [[nodiscard]] double ray_distance(const Vector3& origin, const Vector3& direction, double reach) const;

  /// Of a cube, m.
  [[nodiscard]] double side() const { return side_; }
  /// The centre of the cube around a place, m, whether there is one or not.
  [[nodiscard]] Vector3 centre_near(const Vector3& place) const;
  /// Whether the cube around a place holds points.
  [[nodiscard]] bool is_occupied(const Vector3& place) const;

 private:
  using Cube = std::array<int, 3>;
  [[nodiscard]] std::array<double, 3> in_cubes(const Vector3& place) const;
  [[nodiscard]] bool holds(const Cube& cube) const;
  [[nodiscard]] std::size_t index_of(const Cube& cube) const;

  double side_;
  Vector3 corner_;  ///< Of cube (0, 0, 0), m.
  Cube size_{};     ///< Cubes along x, y and z.
  std::vector<bool> occupied_;
};

}  // namespace glocal::clouds
