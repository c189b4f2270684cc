// Rigid motions in space.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "glocal/pose2.hpp"

namespace glocal {

using Vector3 = Eigen::Vector3d;
/// A rotation in space as a unit quaternion (Hamilton's convention): w is the cosine of half the angle. q and
/// -q are the same rotation.
using Quaternion = Eigen::Quaterniond;

/// The turn by an angle about the z axis; its x and y are zero.
[[nodiscard]] inline Quaternion turn_about_z(double angle_rad) {
  return {std::cos(angle_rad / 2.0), 0.0, 0.0, std::sin(angle_rad / 2.0)};
}

/// First b, then a. Eigen's product, brought back to unit length so that long chains of products do not
/// drift; turns about z give a turn about z to the last bit.
[[nodiscard]] inline Quaternion composed(const Quaternion& a, const Quaternion& b) {
  const Quaternion q = a * b;
  // One step of Newton's method towards 1 / norm: the norm is 1 but for rounding.
  return Quaternion((1.5 - 0.5 * q.squaredNorm()) * q.coeffs());
}

/// The turn by |v| rad about the axis v (exponential map of SO(3)).
[[nodiscard]] Quaternion exponential(const Vector3& v);
/// The axis of a rotation, as long as its angle in rad, in [0, pi] (logarithm map of SO(3)).
[[nodiscard]] Vector3 logarithm(const Quaternion& q);

/// The angle of a rotation, rad, in [0, pi].
[[nodiscard]] inline double angle_of(const Quaternion& q) {
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

/// An element of SE(3). A pose named `target_from_source` maps source coordinates to target coordinates.
/// Each pose in the plane is one, with z zero and a turn about z; products of such poses are such
/// poses, to the last bit.
struct Pose3 {
  double x = 0.0;  ///< m
  double y = 0.0;  ///< m
  double z = 0.0;  ///< m
  Quaternion rotation = Quaternion::Identity();

  Pose3() = default;
  Pose3(const Vector3& origin, const Quaternion& turn)
      : x(origin.x()), y(origin.y()), z(origin.z()), rotation(turn) {}
  explicit Pose3(const Vector3& origin) : Pose3(origin, Quaternion::Identity()) {}
  explicit Pose3(const Quaternion& turn) : rotation(turn) {}
  /// A vector or quaternion of Eigen's from {} has any value: it is refused.
  struct Unset {};
  Pose3(Unset, const Quaternion&) = delete;
  Pose3(const Vector3&, Unset) = delete;
  /// Implicit, as a pose in the plane is a pose.
  Pose3(const Pose2& planar) : x(planar.x), y(planar.y), rotation(turn_about_z(planar.theta)) {}

  [[nodiscard]] Vector3 translation() const { return {x, y, z}; }
  /// The direction of the source's x axis, seen from above (yaw): rad, in (-pi, pi].
  [[nodiscard]] double heading() const {
    const Quaternion& q = rotation;
    // In the plane from half the angle, with fewer roundings.
    if (q.x() == 0.0 && q.y() == 0.0) return wrap_angle(2.0 * std::atan2(q.z(), q.w()));
    return wrap_angle(std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                                 q.w() * q.w() + q.x() * q.x() - q.y() * q.y() - q.z() * q.z()));
  }
  /// The angle between the source's z axis and the target's, rad, in [0, pi].
  [[nodiscard]] double tilt() const {
    return 2.0 * std::atan2(std::hypot(rotation.x(), rotation.y()), std::hypot(rotation.w(), rotation.z()));
  }
  /// Whether it is a motion in the plane.
  [[nodiscard]] bool is_planar() const { return z == 0.0 && rotation.x() == 0.0 && rotation.y() == 0.0; }

  friend bool operator==(const Pose3&, const Pose3&) = default;
};

/// What a pose does in the plane seen from above: its place and its heading. Height and tilt are lost.
[[nodiscard]] inline Pose2 seen_from_above(const Pose3& pose) {
  return {pose.x, pose.y, pose.heading()};
}

/// `target_from_source` of a point in the source's frame.
[[nodiscard]] inline Vector3 operator*(const Pose3& pose, const Vector3& v) {
  return pose.translation() + pose.rotation * v;
}

/// `a_from_c = a_from_b * b_from_c`.
[[nodiscard]] inline Pose3 operator*(const Pose3& a, const Pose3& b) {
  return {a * b.translation(), composed(a.rotation, b.rotation)};
}

/// `source_from_target` of a `target_from_source`.
[[nodiscard]] inline Pose3 inverse(const Pose3& pose) {
  const Quaternion back = pose.rotation.conjugate();
  return {back * -pose.translation(), back};
}

/// The same motion where the target's places are `by` farther: in a frame of the same axes whose origin lies
/// at -`by`.
[[nodiscard]] inline Pose3 shifted(const Pose3& pose, const Vector3& by) {
  return {pose.translation() + by, pose.rotation};
}

/// Distance between two origins, m; of equal heights to the last bit as in the plane.
[[nodiscard]] inline double distance(const Pose3& a, const Pose3& b) {
  return std::hypot(std::hypot(a.x - b.x, a.y - b.y), a.z - b.z);
}

/// Smallest rotation between two orientations, rad, in [0, pi].
[[nodiscard]] inline double rotation_between(const Pose3& a, const Pose3& b) {
  return angle_of(composed(a.rotation.conjugate(), b.rotation));
}

}  // namespace glocal
