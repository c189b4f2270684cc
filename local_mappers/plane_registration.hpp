// Moves a cloud onto the surfaces of a local map in space.
#pragma once

#include <cstddef>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "local_mappers/surface_map.hpp"

namespace glocal::local_mappers {

/// What counts as the same surface, m.
struct MatchLimits {
  double match_distance = 0.0;  ///< Farthest a hit may be from its point of the map.
  double kernel = 0.0;          ///< Scale c of the Geman-McClure kernel.
};

struct PlaneRegistration {
  Pose3 local_from_robot;
  std::size_t matches = 0;  ///< Hits that found a point of the map, in the last iteration.
};

/// Iterates Gauss-Newton steps from `start` until they are below 0.1 mm and 0.1 mrad, at most 30. Each
/// minimises the Geman-McClure costs rho(r) = c^2 r^2 / (2 (c^2 + r^2)) of the distances r from hits (robot
/// frame, m) to the planes through their nearest points of the map; where these have no normal, of the
/// distances along x, y and z, with less weight. A surface that is seen from behind is no match. Directions
/// that the points do not determine stay at `start`.
[[nodiscard]] PlaneRegistration register_to_planes(const SurfaceMap& map, const Points& hits,
                                                   const Point& sensor, const Pose3& start,
                                                   const MatchLimits& limits);

}  // namespace glocal::local_mappers
