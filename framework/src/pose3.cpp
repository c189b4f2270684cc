#include "glocal/pose3.hpp"

#include <Eigen/Geometry>

namespace glocal {

Quaternion exponential(const Vector3& v) {
  const double angle = norm(v);
  // sin(angle / 2) / angle, by its series where the quotient loses its digits.
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(angle / 2.0) / angle;
  return {std::cos(angle / 2.0), scale * v.x, scale * v.y, scale * v.z};
}

Vector3 logarithm(const Quaternion& q) {
  const double sine = norm({q.x, q.y, q.z});
  if (sine == 0.0) return {};
  const double angle = 2.0 * std::atan2(sine, std::abs(q.w));
  return ((q.w < 0.0 ? -angle : angle) / sine) * Vector3{q.x, q.y, q.z};
}

Quaternion quaternion_of(const std::array<double, 9>& matrix) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> given(matrix.data());
  const Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::Matrix3d(given)).normalized();
  return {q.w(), q.x(), q.y(), q.z()};
}

std::array<double, 9> matrix_of(const Quaternion& q) {
  const Vector3 x = rotated(q, {1.0, 0.0, 0.0});
  const Vector3 y = rotated(q, {0.0, 1.0, 0.0});
  const Vector3 z = rotated(q, {0.0, 0.0, 1.0});
  return {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
}

}  // namespace glocal
