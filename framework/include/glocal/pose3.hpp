// Rigid motions in space.
#pragma once

#include <array>
#include <cmath>

#include "glocal/pose2.hpp"

namespace glocal {

/// A vector in space.
struct Vector3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend bool operator==(const Vector3&, const Vector3&) = default;
};

[[nodiscard]] inline Vector3 operator+(const Vector3& a, const Vector3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] inline Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Vector3 operator*(double factor, const Vector3& v) {
  return {factor * v.x, factor * v.y, factor * v.z};
}
[[nodiscard]] inline double norm(const Vector3& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

/// A rotation in space as a unit quaternion (Hamilton's convention): w is the cosine of half the angle. q and
/// -q are the same rotation.
struct Quaternion {
  double w = 1.0;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// The turn by an angle about the z axis; its x and y are zero.
[[nodiscard]] inline Quaternion turn_about_z(double angle_rad) {
  return {std::cos(angle_rad / 2.0), 0.0, 0.0, std::sin(angle_rad / 2.0)};
}

/// First b, then a. Brought back to unit length, so that long chains of products do not drift; turns about z
/// give a turn about z to the last bit.
[[nodiscard]] inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  const Quaternion q{
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  // One step of Newton's method towards 1 / norm: the norm is 1 but for rounding.
  const double scale = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

/// The opposite rotation.
[[nodiscard]] inline Quaternion inverse(const Quaternion& q) {
  return {q.w, -q.x, -q.y, -q.z};
}

/// v, turned by q.
[[nodiscard]] inline Vector3 rotated(const Quaternion& q, const Vector3& v) {
  const Vector3 t{2.0 * (q.y * v.z - q.z * v.y), 2.0 * (q.z * v.x - q.x * v.z),
                  2.0 * (q.x * v.y - q.y * v.x)};
  return {v.x + q.w * t.x + q.y * t.z - q.z * t.y, v.y + q.w * t.y + q.z * t.x - q.x * t.z,
          v.z + q.w * t.z + q.x * t.y - q.y * t.x};
}

/// The turn by |v| rad about the axis v (exponential map of SO(3)).
[[nodiscard]] Quaternion exponential(const Vector3& v);
/// The axis of a rotation, as long as its angle in rad, in [0, pi] (logarithm map of SO(3)).
[[nodiscard]] Vector3 logarithm(const Quaternion& q);

/// The angle of a rotation, rad, in [0, pi].
[[nodiscard]] inline double angle_of(const Quaternion& q) {
  return 2.0 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::abs(q.w));
}

/// The rotation whose matrix (row by row) this is. The matrix is a rotation but for rounding.
[[nodiscard]] Quaternion quaternion_of(const std::array<double, 9>& matrix);
/// The matrix of a rotation, row by row.
[[nodiscard]] std::array<double, 9> matrix_of(const Quaternion& q);

/// An element of SE(3). A pose named `target_from_source` maps source coordinates to target coordinates.
/// Each pose in the plane is one, with z, rotation.x and rotation.y zero; products of such poses are such
/// poses, to the last bit.
struct Pose3 {
  double x = 0.0;  ///< m
  double y = 0.0;  ///< m
  double z = 0.0;  ///< m
  Quaternion rotation;

  Pose3() = default;
  Pose3(const Vector3& origin, const Quaternion& turn)
      : x(origin.x), y(origin.y), z(origin.z), rotation(turn) {}
  /// Implicit, as a pose in the plane is a pose.
  Pose3(const Pose2& planar) : x(planar.x), y(planar.y), rotation(turn_about_z(planar.theta)) {}

  [[nodiscard]] Vector3 translation() const { return {x, y, z}; }
  /// The direction of the source's x axis, seen from above (yaw): rad, in (-pi, pi].
  [[nodiscard]] double heading() const {
    const Quaternion& q = rotation;
    // In the plane from half the angle, with fewer roundings.
    if (q.x == 0.0 && q.y == 0.0) return wrap_angle(2.0 * std::atan2(q.z, q.w));
    return wrap_angle(
        std::atan2(2.0 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z));
  }
  /// The angle between the source's z axis and the target's, rad, in [0, pi].
  [[nodiscard]] double tilt() const {
    return 2.0 * std::atan2(std::hypot(rotation.x, rotation.y), std::hypot(rotation.w, rotation.z));
  }
  /// Whether it is a motion in the plane.
  [[nodiscard]] bool is_planar() const { return z == 0.0 && rotation.x == 0.0 && rotation.y == 0.0; }

  friend bool operator==(const Pose3&, const Pose3&) = default;
};

/// What a pose does in the plane seen from above: its place and its heading. Height and tilt are lost.
[[nodiscard]] inline Pose2 seen_from_above(const Pose3& pose) {
  return {pose.x, pose.y, pose.heading()};
}

/// `target_from_source` of a point in the source's frame.
[[nodiscard]] inline Vector3 operator*(const Pose3& pose, const Vector3& v) {
  return pose.translation() + rotated(pose.rotation, v);
}

/// `a_from_c = a_from_b * b_from_c`.
[[nodiscard]] inline Pose3 operator*(const Pose3& a, const Pose3& b) {
  return {a * b.translation(), a.rotation * b.rotation};
}

/// `source_from_target` of a `target_from_source`.
[[nodiscard]] inline Pose3 inverse(const Pose3& pose) {
  const Quaternion back = inverse(pose.rotation);
  return {rotated(back, {-pose.x, -pose.y, -pose.z}), back};
}

/// Distance between two origins, m; of equal heights to the last bit as in the plane.
[[nodiscard]] inline double distance(const Pose3& a, const Pose3& b) {
  return std::hypot(std::hypot(a.x - b.x, a.y - b.y), a.z - b.z);
}

/// Smallest rotation between two orientations, rad, in [0, pi].
[[nodiscard]] inline double rotation_between(const Pose3& a, const Pose3& b) {
  return angle_of(inverse(a.rotation) * b.rotation);
}

}  // namespace glocal
