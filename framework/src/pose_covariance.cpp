#include "glocal/pose_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <limits>

namespace glocal {

double normalised_error_squared(const Pose2& estimate, const Pose2& reference, const PoseCovariance& c) {
  const Eigen::Vector3d error(estimate.x - reference.x, estimate.y - reference.y,
                              wrap_angle(estimate.theta - reference.theta));
  Eigen::Matrix3d matrix;
  matrix << c.xx, c.xy, c.xt, c.xy, c.yy, c.yt, c.xt, c.yt, c.tt;
  const Eigen::LLT<Eigen::Matrix3d> solver(matrix);
  if (solver.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return error.dot(solver.solve(error));
}

}  // namespace glocal
