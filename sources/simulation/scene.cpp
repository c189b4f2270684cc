#include "sources/simulation/scene.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace glocal::simulation {
namespace {

constexpr double nothing = std::numeric_limits<double>::infinity();

/// Distance along a ray that begins at height z and rises by so much for each metre.
double distance_to_level(double height, double z, double rise) {
  const double distance = (height - z) / rise;
  if (!(distance >= 0.0)) return nothing;  // not even where the ray runs within the surface
  return distance;
}

}  // namespace

Scene::Scene(World world, std::optional<clouds::CloudVoxels> cloud)
    : world_(std::move(world)), reality_(shapes_in_reality(world_)), cloud_(std::move(cloud)) {}

void Scene::look_around(double reach, double time) {
  reach_ = reach;
  people_.circles = people_at(world_, time);
}

double Scene::ray_distance(const Vector3& origin, const Vector3& direction) const {
  const Vector3 over_floor = origin - world_.floor * Vector3::UnitZ();
  double nearest = std::min(reality_.ray_distance_in_space(over_floor, direction, reach_),
                            ray_distance_in_space(people_, over_floor, direction));
  if (world_.ceiling > 0.0)
    nearest = std::min(nearest, distance_to_level(world_.ceiling, over_floor.z(), direction.z()));
  if (!cloud_) return std::min(nearest, distance_to_level(0.0, over_floor.z(), direction.z()));
  return std::min(nearest, cloud_distance(origin, direction, std::min(reach_, nearest)));
}

double Scene::cloud_distance(const Vector3& origin, const Vector3& direction, double reach) const {
  return cloud_ ? cloud_->ray_distance(origin, direction, reach) : nothing;
}

}  // namespace glocal::simulation
