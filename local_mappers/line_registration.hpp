// Moves a scan onto the local map as exactly as the points allow.
#pragma once

#include <Eigen/Core>

#include "glocal/local_map.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "local_mappers/point_grid.hpp"

namespace glocal::local_mappers {

struct LineRegistrationParams {
  double match_distance = 0.45;
};
void describe(ParamVisitor& v, LineRegistrationParams& p);

/// A robust least-squares problem, linearised at a pose: step = -hessian^-1 gradient, in (m, m, rad), where a
/// step moves the robot in the local frame and turns it about itself.
struct NormalEquations {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double cost = 0.0;  ///< m^2; `gradient` is its derivative as long as the same points match.
  int matches = 0;    ///< Hits that found a point of the map.
};

/// Matches hits (robot frame, with their normals) to nearest points of the map and sums up the Geman-McClure
/// costs rho(r) = c^2 r^2 / (2 (c^2 + r^2)), c = match_distance / 3, of the distances r to the lines through
/// these points; where either has no normal, of the distances along x and y, with less weight.
[[nodiscard]] NormalEquations linearise(const PointGrid& grid, const LocalMap& map, const Points& hits,
                                        const Points& normals, const Pose2& local_from_robot,
                                        double match_distance);

struct ScanRegistration {
  Pose2 local_from_robot;
  int matches = 0;  ///< In the last iteration.
};

/// Iterates Gauss-Newton steps from `start` until they are below 0.1 mm and 0.1 mrad, at most 20. Directions
/// the points do not determine (along a bare corridor) stay at `start`.
[[nodiscard]] ScanRegistration register_scan(const PointGrid& grid, const LocalMap& map, const Points& hits,
                                             const Points& normals, const Pose2& start,
                                             double match_distance);

}  // namespace glocal::local_mappers
