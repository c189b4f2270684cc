#include "local_mappers/plane_registration.hpp"

#include <optional>

#include "glocal/motion_equations.hpp"

namespace glocal::local_mappers {
namespace {

/// What keeps a step from running away.
struct StepRules {
  static constexpr double pointwise_weight = 0.1;  ///< Of matches without normals; others have weight 1.
  /// Added to the diagonal of the normal equations per match: keeps directions still that no match sees.
  static constexpr double damping = 1e-3;
  static constexpr int most = 30;
};
constexpr double small_step_m = 1e-4;
constexpr double small_step_rad = 1e-4;

}  // namespace

PlaneRegistration register_to_planes(const SurfaceMap& map, const Points& hits, const Point& sensor,
                                     const Pose3& start, const MatchLimits& limits) {
  PlaneRegistration result{start, 0};
  const double kernel_squared = limits.kernel * limits.kernel;
  const Points& points = map.map().points;
  const Points& normals = map.map().normals;
  for (int iteration = 0; iteration < StepRules::most; ++iteration) {
    Pose3& pose = result.local_from_robot;
    const Points placed = moved(hits, pose);
    const Vector3 eye = pose * as_vector(sensor);
    const Vector3 robot = pose.translation();
    MotionEquations<double> equations;
    // Of a residual (m), the distance along `direction` of a hit.
    const auto add = [&](double residual, const Vector3& direction, const Vector3& hit, double weight) {
      const Vector3 turn = (hit - robot).cross(direction);
      const double share = kernel_squared / (kernel_squared + residual * residual);
      equations.add({turn.x(), turn.y(), turn.z(), direction.x(), direction.y(), direction.z()}, residual,
                    weight * share * share);
    };
    result.matches = 0;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const std::optional<std::size_t> found = map.nearest(placed[i], limits.match_distance);
      if (!found) continue;
      const Vector3 hit = as_vector(placed[i]);
      const Vector3 offset = hit - as_vector(points[*found]);
      if (normals[*found] == Point{}) {
        for (int axis = 0; axis < 3; ++axis)
          add(offset[axis], Vector3::Unit(axis), hit, StepRules::pointwise_weight);
      } else {
        const Vector3 normal = as_vector(normals[*found]);
        if (normal.dot(eye - hit) < 0.0) continue;
        add(normal.dot(offset), normal, hit, 1.0);
      }
      ++result.matches;
    }
    if (result.matches == 0) return result;
    const MotionStep step = equations.step(StepRules::damping * static_cast<double>(result.matches));
    pose = stepped(pose, step);
    if (step.tail<3>().norm() < small_step_m && step.head<3>().norm() < small_step_rad) break;
  }
  return result;
}

}  // namespace glocal::local_mappers
