// What the rays of a lidar meet in a simulated world.
#pragma once

#include <optional>

#include "sources/clouds/cloud_voxels.hpp"
#include "sources/simulation/near_shapes.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// What is there in reality: things, people, floor and ceiling, and the world's cloud.
class Scene {
 public:
  /// `cloud`: the world's, if it has one.
  explicit Scene(World world, std::optional<clouds::CloudVoxels> cloud = {});

  /// Rays meet what is within `reach` (m) at a time (s after the start) from now on.
  void look_around(double reach, double time);
  /// Distance from a place along a unit vector to what a ray meets, m; beyond the reach, or infinite, if
  /// there is nothing within it.
  [[nodiscard]] double ray_distance(const Vector3& origin, const Vector3& direction) const;
  /// The same to the cloud alone.
  [[nodiscard]] double cloud_distance(const Vector3& origin, const Vector3& direction, double reach) const;

 private:
  World world_;
  NearShapes reality_;
  std::optional<clouds::CloudVoxels> cloud_;
  Shapes people_;
  double reach_ = 0.0;  ///< m
};

}  // namespace glocal::simulation
