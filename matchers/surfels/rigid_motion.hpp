// Rigid motions in space as inner loops want them.
#pragma once

#include <array>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

[[nodiscard]] inline Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] inline Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Point operator*(float factor, const Point& p) {
  return {factor * p.x, factor * p.y, factor * p.z};
}
[[nodiscard]] inline float dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline float length(const Point& p) {
  return std::sqrt(dot(p, p));
}

/// A pose with the matrix of its rotation at hand (row by row), for moving many points.
struct RigidMotion {
  std::array<float, 9> rotation{1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  Point translation;

  RigidMotion() = default;
  explicit RigidMotion(const Pose3& target_from_source)
      : translation(as_point(target_from_source.translation())) {
    const std::array<double, 9> matrix = matrix_of(target_from_source.rotation);
    for (std::size_t i = 0; i < 9; ++i) rotation[i] = static_cast<float>(matrix[i]);
  }

  /// A direction, turned.
  [[nodiscard]] Point turned(const Point& v) const {
    const auto& r = rotation;
    return {r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
            r[6] * v.x + r[7] * v.y + r[8] * v.z};
  }
  /// The opposite of turned().
  [[nodiscard]] Point turned_back(const Point& v) const {
    const auto& r = rotation;
    return {r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
            r[2] * v.x + r[5] * v.y + r[8] * v.z};
  }
  [[nodiscard]] Point operator()(const Point& p) const { return turned(p) + translation; }

  [[nodiscard]] Pose3 pose() const {
    std::array<double, 9> matrix{};
    for (std::size_t i = 0; i < 9; ++i) matrix[i] = static_cast<double>(rotation[i]);
    return {as_vector(translation), quaternion_of(matrix)};
  }
};

/// `source_from_target` of a `target_from_source`.
[[nodiscard]] inline RigidMotion inverse(const RigidMotion& motion) {
  const auto& r = motion.rotation;
  RigidMotion back;
  back.rotation = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
  back.translation = -1.0F * motion.turned_back(motion.translation);
  return back;
}

/// Whether a motion that a few points propose can be one of clouds which both stand upright: such motions are
/// a few degrees off.
[[nodiscard]] inline bool is_about_upright(const RigidMotion& motion) {
  constexpr float least_cosine = 0.97F;  // 14 degrees
  return motion.rotation[8] >= least_cosine;
}

/// The turn about z, with a shift, that is nearest to a motion and moves one point as it does.
[[nodiscard]] inline RigidMotion made_upright(const RigidMotion& motion, const Point& moved_alike) {
  const auto& r = motion.rotation;
  const float cosine = r[0] + r[4];
  const float sine = r[3] - r[1];
  const float scale = 1.0F / std::hypot(cosine, sine);
  const float c = scale * cosine;
  const float s = scale * sine;
  RigidMotion result;
  result.rotation = {c, -s, 0.0F, s, c, 0.0F, 0.0F, 0.0F, 1.0F};
  result.translation = motion(moved_alike) - result.turned(moved_alike);
  return result;
}

/// The cosine of the angle between two orientations.
[[nodiscard]] inline float cosine_between(const RigidMotion& a, const RigidMotion& b) {
  float trace = 0.0F;
  for (std::size_t i = 0; i < 9; ++i) trace += a.rotation[i] * b.rotation[i];
  return (trace - 1.0F) / 2.0F;
}

}  // namespace glocal
