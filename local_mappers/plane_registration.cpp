#include "local_mappers/plane_registration.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

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

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A robust least-squares problem, linearised at a pose. A step moves the robot in the local frame (m) and
/// turns it about itself, about the axes of the local frame (rad).
class SpatialNormalEquations {
 public:
  explicit SpatialNormalEquations(double kernel) : kernel_squared_(kernel * kernel) {}

  /// One residual (m), the distance along `direction` of a hit that is at `lever` from the robot.
  void add(double residual, const Vector3& direction, const Vector3& lever, double weight) {
    const double share = kernel_squared_ / (kernel_squared_ + residual * residual);
    const double w = weight * share * share;
    Vector6 derivative;
    derivative << direction, lever.cross(direction);
    hessian_.noalias() += w * derivative * derivative.transpose();
    gradient_.noalias() += w * residual * derivative;
  }

  [[nodiscard]] Vector6 step(std::size_t matches) const {
    const Matrix6 damped = hessian_ + StepRules::damping * static_cast<double>(matches) * Matrix6::Identity();
    return damped.ldlt().solve(-gradient_);
  }

 private:
  double kernel_squared_;
  Matrix6 hessian_ = Matrix6::Zero();
  Vector6 gradient_ = Vector6::Zero();
};

}  // namespace

PlaneRegistration register_to_planes(const SurfaceMap& map, const Points& hits, const Point& sensor,
                                     const Pose3& start, const MatchLimits& limits) {
  PlaneRegistration result{start, 0};
  const Points& points = map.map().points;
  const Points& normals = map.map().normals;
  for (int iteration = 0; iteration < StepRules::most; ++iteration) {
    Pose3& pose = result.local_from_robot;
    const Points placed = moved(hits, pose);
    const Vector3 eye = pose * as_vector(sensor);
    const Vector3 robot = pose.translation();
    SpatialNormalEquations equations(limits.kernel);
    result.matches = 0;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const std::optional<std::size_t> found = map.nearest(placed[i], limits.match_distance);
      if (!found) continue;
      const Vector3 hit = as_vector(placed[i]);
      const Vector3 offset = hit - as_vector(points[*found]);
      if (normals[*found] == Point{}) {
        for (int axis = 0; axis < 3; ++axis)
          equations.add(offset[axis], Vector3::Unit(axis), hit - robot, StepRules::pointwise_weight);
      } else {
        const Vector3 normal = as_vector(normals[*found]);
        if (normal.dot(eye - hit) < 0.0) continue;
        equations.add(normal.dot(offset), normal, hit - robot, 1.0);
      }
      ++result.matches;
    }
    if (result.matches == 0) return result;
    const Vector6 step = equations.step(result.matches);
    pose = {robot + step.head<3>(), composed(exponential(step.tail<3>()), pose.rotation)};
    if (step.head<3>().norm() < small_step_m && step.tail<3>().norm() < small_step_rad) break;
  }
  return result;
}

}  // namespace glocal::local_mappers
