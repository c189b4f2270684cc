// Planar rigid motions.
#pragma once

#include <cmath>
#include <numbers>

namespace glocal {

/// The angle wrapped to (-pi, pi]. Finite input only.
[[nodiscard]] inline double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

[[nodiscard]] constexpr double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}
[[nodiscard]] constexpr double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

/// An element of SE(2). A pose named `target_from_source` maps source coordinates to target coordinates.
struct Pose2 {
  double x = 0.0;      ///< m
  double y = 0.0;      ///< m
  double theta = 0.0;  ///< rad, in (-pi, pi]

  friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// No map reaches farther from its origin along x, y and z, m: planar coordinates on Earth (UTM) do not.
inline constexpr double farthest_m = 1e7;

/// `a_from_c = a_from_b * b_from_c`.
[[nodiscard]] inline Pose2 operator*(const Pose2& a, const Pose2& b) {
  const double c = std::cos(a.theta);
  const double s = std::sin(a.theta);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, wrap_angle(a.theta + b.theta)};
}

/// `source_from_target` of a `target_from_source`.
[[nodiscard]] inline Pose2 inverse(const Pose2& p) {
  const double c = std::cos(p.theta);
  const double s = std::sin(p.theta);
  return {-c * p.x - s * p.y, s * p.x - c * p.y, wrap_angle(-p.theta)};
}

/// Distance between two origins, m.
[[nodiscard]] inline double distance(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Smallest rotation between two headings, rad, in [0, pi].
[[nodiscard]] inline double rotation_between(const Pose2& a, const Pose2& b) {
  return std::abs(wrap_angle(a.theta - b.theta));
}

}  // namespace glocal
