#include "glocal/pose3.hpp"

namespace glocal {

Quaternion exponential(const Vector3& v) {
  const double angle = v.norm();
  // sin(angle / 2) / angle, by its series where the quotient loses its digits.
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(angle / 2.0) / angle;
  return {std::cos(angle / 2.0), scale * v.x(), scale * v.y(), scale * v.z()};
}

Vector3 logarithm(const Quaternion& q) {
  const double sine = q.vec().norm();
  if (sine == 0.0) return Vector3::Zero();
  const double angle = 2.0 * std::atan2(sine, std::abs(q.w()));
  return (q.w() < 0.0 ? -angle : angle) / sine * q.vec();
}

}  // namespace glocal
